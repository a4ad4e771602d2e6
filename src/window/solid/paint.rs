//! A solid picture as a shape of egui: prepared in a texture of its own before egui's pass, laid into it in its turn.

use super::camera::{Camera, Projection};
use super::mesh::Mesh;
use super::pipeline::{SceneUniform, Studio};
use egui::{Context, Id, Painter, Rect};
use egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor, wgpu};
use nalgebra::Vector3;
use std::sync::Arc;

/// What to do where nothing can be drawn in space.
pub(crate) const NO_ADAPTER: &str = "Drawing in space needs a Vulkan or OpenGL driver; the packages libvulkan1 and mesa-vulkan-drivers hold one in software.";

/// Part of the light that comes from everywhere.
const AMBIENT: f32 = 0.60;

/// A mesh, how it is looked at, and where it stands on the screen.
#[derive(Debug, Clone)]
pub(crate) struct Solid {
    /// Tells one picture on the screen from another; its textures are kept under it.
    pub id: Id,
    /// What is drawn. Uploaded when it is another one than at the last frame.
    pub mesh: Arc<Mesh>,
    /// How it is looked at.
    pub projection: Projection,
    /// Where it stands on the screen, points.
    pub viewport: Rect,
    /// Radius about the projection's middle that holds everything, in units of length.
    pub reach: f32,
}

/// Builds the pipelines once for a window. Without a graphics state nothing happens, and [`available`] says so.
pub(crate) fn install(ctx: &Context, state: Option<&RenderState>) {
    let Some(state) = state else { return };
    if available(ctx) {
        return;
    }
    let studio = Studio::new(&state.device, state.target_format);
    state.renderer.write().callback_resources.insert(studio);
    ctx.data_mut(|d| d.insert_temp(Id::NULL.with("graphics state"), state.clone()));
}

/// Whether solids can be drawn in this window.
pub(crate) fn available(ctx: &Context) -> bool {
    graphics(ctx).is_some()
}

/// The graphics state of this window.
pub(crate) fn graphics(ctx: &Context) -> Option<RenderState> {
    ctx.data(|d| d.get_temp(Id::NULL.with("graphics state")))
}

/// Unit vector to the light: from the left and above, fixed to the eye.
fn light(camera: Camera) -> Vector3<f32> {
    let [right, up, toward] = camera.axes();
    (toward * 0.8 - right * 0.45 + up * 0.55).normalize()
}

/// Brightness of a face with an outward unit vector; what the shader computes.
pub(crate) fn shade(camera: Camera, normal: Vector3<f32>) -> f32 {
    AMBIENT + (1.0 - AMBIENT) * normal.dot(&light(camera)).max(0.0)
}

impl Solid {
    /// Adds it to what is painted.
    pub(crate) fn paint(self, painter: &Painter) {
        if self.viewport.width() >= 1.0 && self.viewport.height() >= 1.0 {
            painter.add(egui_wgpu::Callback::new_paint_callback(self.viewport, self));
        }
    }

    fn uniform(&self) -> SceneUniform {
        let light = light(self.projection.camera);
        SceneUniform {
            clip: self.projection.clip(self.viewport, self.reach),
            light: [light.x, light.y, light.z, AMBIENT],
        }
    }

    /// Width and height in pixels, at most what every adapter can draw on.
    fn pixels(&self, screen: &ScreenDescriptor) -> [u32; 2] {
        let pixel = |v: f32| (v * screen.pixels_per_point).round() as i64;
        let (min, max) = (self.viewport.min, self.viewport.max);
        [pixel(max.x) - pixel(min.x), pixel(max.y) - pixel(min.y)].map(|n| n.clamp(1, 8192) as u32)
    }
}

impl CallbackTrait for Solid {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        if let Some(studio) = resources.get_mut::<Studio>() {
            studio.draw(device, queue, encoder, self.id, &self.mesh, self.uniform(), self.pixels(screen));
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: egui::PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(studio) = resources.get::<Studio>() {
            studio.lay(pass, self.id);
        }
    }
}
