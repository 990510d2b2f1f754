//! How trees reach the GPU.

mod shader_files;

pub(crate) use shader_files::load_shaders;
