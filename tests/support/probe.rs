//! A compute shader that runs in every frame, so that what the GPU computes can be read back.

use super::{ReadBack, floats, read_every_frame, render_frame};
use bevy::{
    core_pipeline::schedule::camera_driver,
    ecs::system::SystemParam,
    prelude::*,
    render::{
        RenderApp,
        extract_resource::{ExtractResource, ExtractResourcePlugin},
        render_asset::RenderAssets,
        render_resource::{
            BindGroupEntry, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindGroupLayoutEntryBuilder, BufferUsages,
            CachedComputePipelineId, ComputePassDescriptor, ComputePipelineDescriptor, PipelineCache, ShaderStages,
            binding_types::{storage_buffer_read_only_sized, storage_buffer_sized, uniform_buffer_sized},
        },
        renderer::{RenderContext, RenderDevice, RenderGraph},
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
    shader::{Shader, ShaderDefVal},
};
use std::num::NonZeroU64;

/// A shader with samples at binding 0, results at binding 1, 64 threads a workgroup, and what else it binds.
#[derive(Resource, ExtractResource, Clone)]
#[extract_app(RenderApp)]
struct Probe {
    entry_point: &'static str,
    shader: Handle<Shader>,
    bound: Vec<(u32, Bound)>,
    threads: u32,
}

/// What a probe binds.
#[derive(Clone)]
pub enum Bound {
    Table(Handle<ShaderBuffer>),
    Results(Handle<ShaderBuffer>),
    /// A uniform, and its size in bytes.
    Uniform(Handle<ShaderBuffer>, u64),
}

/// Lets one probe run before anything is drawn. It goes before `App::finish`.
pub fn plugin(app: &mut App) {
    app.add_plugins(ExtractResourcePlugin::<Probe>::default());
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app.add_systems(RenderGraph, run_probe.before(camera_driver));
    }
}

/// A uniform of these bytes.
pub fn uniform(world: &mut World, values: Vec<Vec4>) -> Bound {
    let bytes = size_of_val(values.as_slice()) as u64;
    let mut buffer = ShaderBuffer::from(values);
    buffer.buffer_usage |= BufferUsages::UNIFORM;
    Bound::Uniform(world.resource_mut::<Assets<ShaderBuffer>>().add(buffer), bytes)
}

/// The source of a probe, in WESL.
pub struct ProbeSource {
    pub entry_point: &'static str,
    pub wesl: &'static str,
}

/// Begins to run a probe on `threads` samples, that writes `rows` rows for each; `bound` is what it binds beside these.
pub fn install(
    world: &mut World,
    ProbeSource { entry_point, wesl }: ProbeSource,
    samples: Vec<Vec4>,
    [threads, rows]: [usize; 2],
    bound: impl IntoIterator<Item = (u32, Bound)>,
) -> ReadBack {
    let shader = Shader::from_wesl(wesl, format!("{entry_point}.wesl"));
    let shader = world.resource_mut::<Assets<Shader>>().add(shader);
    let mut buffers = world.resource_mut::<Assets<ShaderBuffer>>();
    let samples = buffers.add(ShaderBuffer::from(samples));
    let results = buffers.add(ShaderBuffer::from(vec![Vec4::ZERO; threads * rows]));
    let own = [(0, Bound::Table(samples)), (1, Bound::Results(results.clone()))];
    let bound = own.into_iter().chain(bound).collect();
    world.insert_resource(Probe { entry_point, shader, bound, threads: threads as u32 });
    read_every_frame(world, results)
}

/// Results that have been read back since the last call.
pub fn rows(read: &ReadBack) -> Option<Vec<Vec4>> {
    let bytes = read.lock().ok()?.take()?;
    Some(floats(&bytes).chunks_exact(4).map(Vec4::from_slice).collect())
}

/// Renders frames until all results are there. The buffer begins as zeros: `is_written` tells those from a result.
pub fn read_all(app: &mut App, read: &ReadBack, is_written: impl Fn(&Vec4) -> bool) -> Result<Vec<Vec4>, String> {
    const MOST_FRAMES: usize = 200;
    for _ in 0..MOST_FRAMES {
        render_frame(app)?;
        if let Some(rows) = rows(read).filter(|rows| rows.iter().all(&is_written)) {
            return Ok(rows);
        }
    }
    Err("the GPU did not write every result".into())
}

impl Bound {
    fn handle(&self) -> &Handle<ShaderBuffer> {
        let (Self::Table(handle) | Self::Results(handle) | Self::Uniform(handle, _)) = self;
        handle
    }

    fn layout(&self) -> BindGroupLayoutEntryBuilder {
        match self {
            Self::Table(_) => storage_buffer_read_only_sized(false, None),
            Self::Results(_) => storage_buffer_sized(false, None),
            Self::Uniform(_, bytes) => uniform_buffer_sized(false, NonZeroU64::new(*bytes)),
        }
    }
}

fn run_probe(mut pass: ProbePass, probe: Option<Res<Probe>>, buffers: Res<RenderAssets<GpuShaderBuffer>>) {
    let Some(probe) = probe else { return };
    let layout: Vec<_> =
        probe.bound.iter().map(|(binding, bound)| bound.layout().build(*binding, ShaderStages::COMPUTE)).collect();
    let buffer = |bound: &Bound| Some(buffers.get(bound.handle())?.buffer.as_entire_binding());
    let entry = |(binding, bound): &(u32, Bound)| Some(BindGroupEntry { binding: *binding, resource: buffer(bound)? });
    let Some(entries) = probe.bound.iter().map(entry).collect::<Option<Vec<_>>>() else { return };
    let shader = ProbeShader { entry_point: probe.entry_point, shader: &probe.shader };
    pass.run(shader, &layout, &entries, [probe.threads.div_ceil(64), 1]);
}

/// The shader, by its entry point.
pub struct ProbeShader<'a> {
    pub entry_point: &'static str,
    pub shader: &'a Handle<Shader>,
}

/// What a system of the render graph needs to run the shader.
#[derive(SystemParam)]
pub struct ProbePass<'w, 's> {
    context: RenderContext<'w, 's>,
    commands: Commands<'w, 's>,
    pipeline: Option<Res<'w, ProbePipeline>>,
    device: Res<'w, RenderDevice>,
    cache: Res<'w, PipelineCache>,
}

#[derive(Resource)]
struct ProbePipeline {
    layout: BindGroupLayoutDescriptor,
    id: CachedComputePipelineId,
}

impl ProbePass<'_, '_> {
    /// Runs the shader. The first call queues its pipeline, and until that has compiled nothing is run.
    pub fn run(
        &mut self,
        shader: ProbeShader,
        layout: &[BindGroupLayoutEntry],
        bindings: &[BindGroupEntry],
        workgroups: [u32; 2],
    ) {
        let name = shader.entry_point;
        let Some(ProbePipeline { layout, id }) = self.pipeline.as_deref() else {
            self.commands.insert_resource(queue(&self.cache, shader, layout));
            return;
        };
        let Some(pipeline) = self.cache.get_compute_pipeline(*id) else { return };
        let group = self.device.create_bind_group(name, &self.cache.get_bind_group_layout(layout), bindings);
        let descriptor = ComputePassDescriptor { label: Some(name), timestamp_writes: None };
        let mut pass = self.context.command_encoder().begin_compute_pass(&descriptor);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(workgroups[0], workgroups[1], 1);
    }
}

fn queue(cache: &PipelineCache, shader: ProbeShader, layout: &[BindGroupLayoutEntry]) -> ProbePipeline {
    let layout = BindGroupLayoutDescriptor::new(shader.entry_point, layout);
    let id = cache.queue_compute_pipeline(ComputePipelineDescriptor {
        label: Some(shader.entry_point.into()),
        layout: vec![layout.clone()],
        shader: shader.shader.clone(),
        // What the crate's modules bind lies in the only group here.
        shader_defs: vec![ShaderDefVal::UInt("MATERIAL_BIND_GROUP".into(), 0)],
        entry_point: Some(shader.entry_point.into()),
        ..default()
    });
    ProbePipeline { layout, id }
}
