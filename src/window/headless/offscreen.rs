//! Frames of egui drawn into memory through wgpu, without a window.

use crate::window::solid;
use egui::{Context, Event, FullOutput, RawInput, Rect, Ui, Vec2, pos2};
use egui_wgpu::{
    RenderState, Renderer, RendererOptions, ScreenDescriptor, WgpuConfiguration, WgpuError, WgpuSetup,
    WgpuSetupCreateNew, wgpu,
};
use std::sync::Arc;
use std::time::Duration;

/// Frames after which a layout without jobs stands still.
const SETTLED: usize = 8;
/// Frames after which a job is given up.
const MOST: usize = 20_000;

/// A picture in memory.
pub struct Offscreen {
    state: RenderState,
    size: [u32; 2],
    points: f32,
}

impl Offscreen {
    /// A picture of `size` pixels with `points` pixels a point, on an adapter of its own: a software one before any other,
    /// so that pictures are the same on every machine.
    ///
    /// # Errors
    /// One line that says which package to install where there is no adapter.
    pub fn new(size: [u32; 2], points: f32) -> Result<Self, String> {
        Ok(Self { state: adapter()?, size, points })
    }

    /// The same on the device of a window, where there is one.
    ///
    /// # Errors
    /// As [`Offscreen::new`].
    pub fn beside(state: Option<RenderState>, size: [u32; 2], points: f32) -> Result<Self, String> {
        let Some(state) = state else { return Self::new(size, points) };
        let format = wgpu::TextureFormat::Rgba8Unorm;
        let renderer = Renderer::new(&state.device, format, RendererOptions::PREDICTABLE);
        let renderer = Arc::new(egui::mutex::RwLock::new(renderer));
        Ok(Self { state: RenderState { renderer, target_format: format, ..state }, size, points })
    }

    /// Runs frames until layouts and jobs have settled, then draws the last one; RGBA rows from the top. `frame` draws and
    /// says whether a job still runs.
    ///
    /// # Errors
    /// One line where the adapter does not answer.
    pub fn settle(&self, ctx: &Context, frame: &mut dyn FnMut(&mut Ui) -> bool) -> Result<Vec<u8>, String> {
        solid::install(ctx, Some(&self.state));
        let (mut number, mut idle) = (0, 0);
        loop {
            let (output, busy) = self.run(ctx, number, frame);
            number += 1;
            // What ended in a frame is shown by those after it.
            idle = if busy { 0 } else { idle + 1 };
            if (number >= SETTLED && idle >= 3) || number >= MOST {
                return self.draw(ctx, output);
            }
            if busy {
                std::thread::sleep(Duration::from_millis(5));
            }
        }
    }

    fn run(&self, ctx: &Context, number: usize, frame: &mut dyn FnMut(&mut Ui) -> bool) -> (FullOutput, bool) {
        let [width, height] = self.size.map(|n| n as f32 / self.points);
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), Vec2::new(width, height))),
            time: Some(number as f64 / 60.0),
            events: vec![Event::PointerGone],
            ..RawInput::default()
        };
        for viewport in input.viewports.values_mut() {
            viewport.native_pixels_per_point = Some(self.points);
        }
        let mut busy = false;
        let mut output = ctx.run_ui(input, |ui| busy = frame(ui));
        self.textures(&mut output);
        (output, busy)
    }

    fn textures(&self, output: &mut FullOutput) {
        let mut renderer = self.state.renderer.write();
        for (id, images) in output.textures_delta.set.drain() {
            for image in images {
                renderer.update_texture(&self.state.device, &self.state.queue, id, &image);
            }
        }
        for id in output.textures_delta.free.drain() {
            renderer.free_texture(&id);
        }
    }

    fn draw(&self, ctx: &Context, output: FullOutput) -> Result<Vec<u8>, String> {
        let (device, queue) = (&self.state.device, &self.state.queue);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let screen = ScreenDescriptor { pixels_per_point: self.points, size_in_pixels: self.size };
        let shapes = ctx.tessellate(output.shapes, self.points);
        let mut renderer = self.state.renderer.write();
        let buffers = renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: self.extent(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.state.target_format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        {
            let mut pass = encoder.begin_render_pass(&pass(&[Some(attachment(&view))])).forget_lifetime();
            renderer.render(&mut pass, &shapes, &screen);
        }
        drop(renderer);
        let (buffer, row) = self.copy(&mut encoder, &texture);
        queue.submit(buffers.into_iter().chain([encoder.finish()]));
        self.read(&buffer, row)
    }

    fn extent(&self) -> wgpu::Extent3d {
        wgpu::Extent3d { width: self.size[0], height: self.size[1], depth_or_array_layers: 1 }
    }

    fn copy(&self, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture) -> (wgpu::Buffer, u32) {
        let row = (4 * self.size[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.state.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(row) * u64::from(self.size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), target, self.extent());
        (buffer, row)
    }

    fn read(&self, buffer: &wgpu::Buffer, row: u32) -> Result<Vec<u8>, String> {
        let slice = buffer.slice(..);
        slice.map_async(wgpu::MapMode::Read, |_| {});
        let wait = wgpu::PollType::Wait { submission_index: None, timeout: Some(Duration::from_secs(30)) };
        self.state.device.poll(wait).map_err(|e| format!("the graphics adapter does not answer: {e}"))?;
        let data = slice.get_mapped_range().map_err(|e| format!("the picture cannot be read back: {e}"))?;
        let swap =
            matches!(self.state.target_format, wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Bgra8UnormSrgb);
        let pixel = |p: &[u8]| if swap { [p[2], p[1], p[0], 255] } else { [p[0], p[1], p[2], 255] };
        let line = |y: u32| {
            let start = (y * row) as usize;
            data[start..start + 4 * self.size[0] as usize].chunks_exact(4).flat_map(pixel).collect::<Vec<u8>>()
        };
        Ok((0..self.size[1]).flat_map(line).collect())
    }
}

/// How an adapter without a display is chosen among those of `backends`: a software one before any other.
pub fn setup(backends: wgpu::Backends) -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = backends;
    setup.native_adapter_selector = Some(Arc::new(|adapters, _surface| {
        let rank = |a: &&wgpu::Adapter| match a.get_info().device_type {
            wgpu::DeviceType::Cpu => 0,
            wgpu::DeviceType::DiscreteGpu => 1,
            _ => 2,
        };
        adapters.iter().min_by_key(rank).cloned().ok_or_else(|| "none".to_owned())
    }));
    WgpuSetup::CreateNew(setup)
}

/// Opens an adapter. OpenGL is asked only where nothing else is there: without a display its libraries complain.
fn adapter() -> Result<RenderState, String> {
    open(wgpu::Backends::PRIMARY).or_else(|_| open(wgpu::Backends::GL)).map_err(|_| {
        "no graphics adapter: install a Vulkan driver; the packages libvulkan1 and mesa-vulkan-drivers hold one in software"
            .to_owned()
    })
}

fn open(backends: wgpu::Backends) -> Result<RenderState, WgpuError> {
    let setup = setup(backends);
    let instance = pollster::block_on(setup.new_instance());
    let configuration = WgpuConfiguration { wgpu_setup: setup, ..WgpuConfiguration::default() };
    pollster::block_on(RenderState::create(&configuration, &instance, None, RendererOptions::PREDICTABLE))
}

fn attachment(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        resolve_target: None,
        depth_slice: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
    }
}

fn pass<'a>(attachments: &'a [Option<wgpu::RenderPassColorAttachment<'a>>]) -> wgpu::RenderPassDescriptor<'a> {
    wgpu::RenderPassDescriptor { color_attachments: attachments, ..wgpu::RenderPassDescriptor::default() }
}
