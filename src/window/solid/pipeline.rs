//! The pipeline: bodies with depth and four samples a pixel into a texture, the texture into egui's pass.

use super::mesh::{Mesh, Vertex};
use egui::Id;
use egui_wgpu::wgpu;
use std::collections::HashMap;
use std::sync::Arc;
use wgpu::util::DeviceExt as _;

const SAMPLES: u32 = 4;
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Pictures whose textures are kept; more are never on the screen at once.
const MOST: usize = 8;

/// What the pipeline is told at every frame.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct SceneUniform {
    /// Columns of the matrix from space to clip space.
    pub clip: [[f32; 4]; 4],
    /// Unit vector to the light, and the share of light from everywhere.
    pub light: [f32; 4],
}

/// Pipelines and what each picture keeps between frames.
pub(super) struct Studio {
    body: wgpu::RenderPipeline,
    lay: wgpu::RenderPipeline,
    pictures: HashMap<Id, Picture>,
    frame: u64,
}

/// Textures and buffers of one picture.
struct Picture {
    size: [u32; 2],
    many: wgpu::TextureView,
    depth: wgpu::TextureView,
    one: wgpu::TextureView,
    laid: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    scene: wgpu::BindGroup,
    mesh: Option<Uploaded>,
    used: u64,
}

struct Uploaded {
    source: Arc<Mesh>,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl Studio {
    /// Builds both pipelines; `target` is the format of egui's pass.
    pub(super) fn new(device: &wgpu::Device, target: wgpu::TextureFormat) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("solid"),
            source: wgpu::ShaderSource::Wgsl(include_str!("shader.wgsl").into()),
        });
        let (body, lay) = (body_pipeline(device, &module), lay_pipeline(device, &module, target));
        Self { body, lay, pictures: HashMap::new(), frame: 0 }
    }

    /// Draws a mesh into its picture's texture.
    #[expect(clippy::too_many_arguments, reason = "device, queue and encoder always go together and come from egui")]
    pub(super) fn draw(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        id: Id,
        mesh: &Arc<Mesh>,
        uniform: SceneUniform,
        size: [u32; 2],
    ) {
        self.frame += 1;
        self.make_room(id);
        if self.pictures.get(&id).is_none_or(|p| p.size != size) {
            let kept = self.pictures.remove(&id).and_then(|p| p.mesh);
            let picture = Picture::new(device, &self.body, &self.lay, size, kept);
            self.pictures.insert(id, picture);
        }
        let Some(picture) = self.pictures.get_mut(&id) else { return };
        picture.used = self.frame;
        queue.write_buffer(&picture.uniform, 0, bytemuck::bytes_of(&uniform));
        if picture.mesh.as_ref().is_none_or(|m| !Arc::ptr_eq(&m.source, mesh)) {
            picture.mesh = upload(device, mesh);
        }
        picture.draw(encoder, &self.body);
    }

    /// Lays a picture into the pass of egui, whose viewport is that of the picture.
    pub(super) fn lay(&self, pass: &mut wgpu::RenderPass<'static>, id: Id) {
        let Some(picture) = self.pictures.get(&id) else { return };
        pass.set_pipeline(&self.lay);
        pass.set_bind_group(0, &picture.laid, &[]);
        pass.draw(0..3, 0..1);
    }

    /// Forgets the picture that was not seen for the longest time, where there are too many.
    fn make_room(&mut self, id: Id) {
        if self.pictures.len() < MOST || self.pictures.contains_key(&id) {
            return;
        }
        if let Some(oldest) = self.pictures.iter().min_by_key(|(_, p)| p.used).map(|(id, _)| *id) {
            self.pictures.remove(&oldest);
        }
    }
}

impl Picture {
    fn new(
        device: &wgpu::Device,
        body: &wgpu::RenderPipeline,
        lay: &wgpu::RenderPipeline,
        size: [u32; 2],
        mesh: Option<Uploaded>,
    ) -> Self {
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let one = texture(device, size, 1, COLOUR, drawn | wgpu::TextureUsages::TEXTURE_BINDING);
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("solid scene"),
            size: size_of::<SceneUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bind = |pipeline: &wgpu::RenderPipeline, resource| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("solid"),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[wgpu::BindGroupEntry { binding: 0, resource }],
            })
        };
        Self {
            size,
            many: texture(device, size, SAMPLES, COLOUR, drawn),
            depth: texture(device, size, SAMPLES, DEPTH, drawn),
            laid: bind(lay, wgpu::BindingResource::TextureView(&one)),
            scene: bind(body, uniform.as_entire_binding()),
            one,
            uniform,
            mesh,
            used: 0,
        }
    }

    fn draw(&self, encoder: &mut wgpu::CommandEncoder, body: &wgpu::RenderPipeline) {
        let colour = wgpu::RenderPassColorAttachment {
            view: &self.many,
            resolve_target: Some(&self.one),
            depth_slice: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Discard,
            },
        };
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("solid"),
            color_attachments: &[Some(colour)],
            depth_stencil_attachment: Some(depth),
            ..wgpu::RenderPassDescriptor::default()
        });
        let Some(mesh) = &self.mesh else { return };
        pass.set_pipeline(body);
        pass.set_bind_group(0, &self.scene, &[]);
        pass.set_vertex_buffer(0, mesh.vertices.slice(..));
        pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..mesh.count, 0, 0..1);
    }
}

fn upload(device: &wgpu::Device, mesh: &Arc<Mesh>) -> Option<Uploaded> {
    if mesh.indices.is_empty() {
        return None;
    }
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some("solid"), contents, usage })
    };
    Some(Uploaded {
        vertices: buffer(bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX),
        indices: buffer(bytemuck::cast_slice(&mesh.indices), wgpu::BufferUsages::INDEX),
        count: mesh.indices.len() as u32,
        source: Arc::clone(mesh),
    })
}

fn texture(
    device: &wgpu::Device,
    size: [u32; 2],
    samples: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureView {
    let most = device.limits().max_texture_dimension_2d;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("solid"),
        size: wgpu::Extent3d { width: size[0].min(most), height: size[1].min(most), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn body_pipeline(device: &wgpu::Device, module: &wgpu::ShaderModule) -> wgpu::RenderPipeline {
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Unorm8x4];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("solid bodies"),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("body"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            })],
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..wgpu::PrimitiveState::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: SAMPLES, ..wgpu::MultisampleState::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("lit"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(COLOUR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn lay_pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    target: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let entry = if target.is_srgb() { "lay_linear" } else { "lay_gamma" };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("solid picture"),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("cover"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: target,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
