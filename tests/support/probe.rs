//! A compute shader that runs in every frame, so that what the GPU computes can be read back.

use bevy::{
    ecs::system::SystemParam,
    prelude::*,
    render::{
        render_resource::{
            BindGroupEntry, BindGroupLayoutDescriptor, BindGroupLayoutEntry, CachedComputePipelineId,
            ComputePassDescriptor, ComputePipelineDescriptor, PipelineCache,
        },
        renderer::{RenderContext, RenderDevice},
    },
    shader::{Shader, ShaderDefVal},
};

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
