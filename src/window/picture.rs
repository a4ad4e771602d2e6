//! A stage drawn without a display, by the same code as the window, through wgpu.

use super::app::App;
use super::frame::panes::Pane;
use super::theme;
use super::view::Stage;
use egui::{Context, Event, FullOutput, RawInput, Rect, Theme, Vec2, pos2};
use egui_wgpu::{
    RenderState, RendererOptions, ScreenDescriptor, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew, wgpu,
};
use std::path::PathBuf;
use std::sync::Arc;

/// What to draw.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Project; `None` draws the start screen.
    pub file: Option<PathBuf>,
    /// Stage.
    pub stage: Stage,
    /// Pane that is to be in front, by name; `matrix` shows the matrix as bars in space.
    pub pane: Option<String>,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Dark theme.
    pub dark: bool,
    /// PNG file to write.
    pub out: PathBuf,
}

/// Draws a picture and writes it.
///
/// # Errors
/// One line that says what is wrong and how to mend it: the project, the adapter, the file.
pub fn picture(picture: &Picture) -> Result<(), String> {
    let ctx = Context::default();
    theme::install(&ctx);
    ctx.set_theme(if picture.dark { Theme::Dark } else { Theme::Light });
    let mut app = App::default();
    if let Some(file) = &picture.file {
        app.open(&ctx, file.clone());
        app.settle()?;
    }
    app.view.stage = picture.stage;
    if let Some(name) = &picture.pane {
        app.view.matrix_in_space = name == "matrix";
        let pane = if name == "matrix" { Pane::Matrix } else { Pane::from_name(name)? };
        app.desk.set_open(picture.stage, pane, true);
    }
    let [width, height] = picture.size;
    let state = render_state()?;
    super::solid::install(&ctx, Some(&state));
    let mut painter = Painter { state: &state, size: picture.size };
    let size = Vec2::new(width as f32, height as f32);
    let pixels = painter.settle(&ctx, size, &mut app)?;
    let image = image::RgbaImage::from_raw(width, height, pixels).ok_or("the picture has the wrong size")?;
    image.save(&picture.out).map_err(|e| format!("{}: cannot be written ({e})", picture.out.display()))
}

/// Opens an adapter, a software one before any other, so that pictures are the same on every machine.
fn render_state() -> Result<RenderState, String> {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.native_adapter_selector = Some(Arc::new(|adapters, _surface| {
        let rank = |a: &&wgpu::Adapter| match a.get_info().device_type {
            wgpu::DeviceType::Cpu => 0,
            wgpu::DeviceType::DiscreteGpu => 1,
            _ => 2,
        };
        adapters.iter().min_by_key(rank).cloned().ok_or_else(|| "none".to_owned())
    }));
    let setup = WgpuSetup::CreateNew(setup);
    let instance = pollster::block_on(setup.new_instance());
    let configuration = WgpuConfiguration { wgpu_setup: setup, ..WgpuConfiguration::default() };
    pollster::block_on(RenderState::create(&configuration, &instance, None, RendererOptions::PREDICTABLE)).map_err(|_| {
        "no graphics adapter: install a Vulkan driver; the packages libvulkan1 and mesa-vulkan-drivers hold one in software"
            .to_owned()
    })
}

struct Painter<'a> {
    state: &'a RenderState,
    size: [u32; 2],
}

impl Painter<'_> {
    /// Runs frames until layouts and jobs have settled, then draws the last one; RGBA rows from the top.
    fn settle(&mut self, ctx: &Context, size: Vec2, app: &mut App) -> Result<Vec<u8>, String> {
        let mut last = self.frame(ctx, size, 0, app);
        let mut frames = 1;
        while frames < 8 || (app.running().is_some() && frames < 20_000) {
            if app.running().is_some() {
                std::thread::sleep(std::time::Duration::from_millis(5));
            }
            last = self.frame(ctx, size, frames, app);
            frames += 1;
        }
        self.draw(ctx, &last)
    }

    fn frame(&mut self, ctx: &Context, size: Vec2, number: usize, app: &mut App) -> FullOutput {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(pos2(0.0, 0.0), size)),
            time: Some(number as f64 / 60.0),
            events: vec![Event::PointerGone],
            ..RawInput::default()
        };
        let mut output = ctx.run_ui(input, |ui| app.frame(ui));
        self.textures(&mut output);
        output
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

    fn draw(&self, ctx: &Context, output: &FullOutput) -> Result<Vec<u8>, String> {
        let (device, queue) = (&self.state.device, &self.state.queue);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let screen = ScreenDescriptor { pixels_per_point: ctx.pixels_per_point(), size_in_pixels: self.size };
        let shapes = ctx.tessellate(output.shapes.clone(), ctx.pixels_per_point());
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
        let wait = wgpu::PollType::Wait { submission_index: None, timeout: Some(std::time::Duration::from_secs(30)) };
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
