//! Pipelines.

use crate::gpu::program::{Constant, Module, Program};

/// The format of depth buffers; every WebGPU device has it.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The settings in which pipelines that draw differ.
#[derive(Clone)]
pub(crate) struct Recipe<'a> {
    pub(crate) program: &'a Program,
    pub(crate) layout: &'a wgpu::PipelineLayout,
    pub(crate) topology: wgpu::PrimitiveTopology,
    pub(crate) buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    pub(crate) cull_mode: Option<wgpu::Face>,
    /// How depths are compared, and whether they are written.
    pub(crate) depth: Option<(wgpu::CompareFunction, bool)>,
    pub(crate) bias: wgpu::DepthBiasState,
    pub(crate) samples: u32,
    pub(crate) target: Option<wgpu::ColorTargetState>,
    /// A second target beside the first.
    pub(crate) beside: Option<wgpu::ColorTargetState>,
}

/// A vertex stage in the place of a program's own, and the modules that it needs besides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OtherVertices {
    pub(crate) entry: &'static str,
    pub(crate) modules: &'static [Module],
}

impl Recipe<'_> {
    pub(crate) fn build(&self, device: &wgpu::Device, choices: &[Constant]) -> wgpu::RenderPipeline {
        self.build_with(device, choices, OtherVertices { entry: self.program.entry, modules: &[] })
    }

    pub(crate) fn build_with(
        &self,
        device: &wgpu::Device,
        choices: &[Constant],
        vertices: OtherVertices,
    ) -> wgpu::RenderPipeline {
        let module = self.program.compiled_with(device, choices, vertices.modules);
        let targets = [self.target.clone(), self.beside.clone()];
        let count = targets.iter().take_while(|target| target.is_some()).count();
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.program.label),
            layout: Some(self.layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertices.entry),
                compilation_options: Default::default(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: self.cull_mode,
                topology: self.topology,
                ..Default::default()
            },
            depth_stencil: self.depth.map(|(compare, writes)| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(writes),
                depth_compare: Some(compare),
                stencil: Default::default(),
                bias: self.bias,
            }),
            multisample: wgpu::MultisampleState { count: self.samples, ..Default::default() },
            fragment: self.program.fragment.map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &targets[..count],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A target of which all channels are written.
pub(crate) fn color_target(
    format: wgpu::TextureFormat,
    blend: Option<wgpu::BlendState>,
) -> Option<wgpu::ColorTargetState> {
    Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })
}

/// A pipeline layout of these groups, in their order.
pub(crate) fn pipeline_layout(
    device: &wgpu::Device,
    label: &str,
    groups: &[&wgpu::BindGroupLayout],
) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().copied().map(Some).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// The pipeline of a compute pass; `groups` are the layouts of its bind groups in their order.
pub(crate) fn compute_pipeline(
    device: &wgpu::Device,
    program: &Program,
    groups: &[&wgpu::BindGroupLayout],
    choices: &[Constant],
) -> wgpu::ComputePipeline {
    let layout = pipeline_layout(device, program.label, groups);
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(program.label),
        layout: Some(&layout),
        module: &program.compiled(device, choices),
        entry_point: Some(program.entry),
        compilation_options: Default::default(),
        cache: None,
    })
}
