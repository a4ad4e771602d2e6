//! A matrix as bars in space: their heights and colours are the values, in the colours of the heat map.
//!
//! Column `j` stands at x from j to j + 1, row `i` at y from n - i - 1 to n - i, so that the first entry is the corner at
//! the back on the left, as on paper.

use super::camera::{Camera, Projection};
use super::frame::RuledBox;
use super::mesh::Mesh;
use super::paint::{Solid, available, shade};
use super::pick::{Ray, nearest};
use super::turn::turn;
use crate::display::format;
use crate::plots::drawing::Drawing;
use crate::plots::grid::round_step;
use crate::plots::heatmap::HeatMap;
use crate::window::appearance::theme::{self, Palette};
use crate::window::appearance::widgets::UiExt;
use crate::window::language::{tf, tr};
use crate::window::plots::export;
use egui::{Id, Rect, Role, Sense, Ui, Vec2, WidgetInfo};
use nalgebra::Vector3;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

/// Free floor on each side of a bar, in cells.
const INSET: f32 = 0.12;
/// Direction in which it stands at first.
const HOME: Camera = Camera { yaw: 5.75, pitch: 0.52, zoom: 1.0 };

/// Bars of the shown rows of a matrix.
#[derive(Debug, Clone)]
pub(crate) struct Bars {
    /// Values, row by row.
    values: Vec<f64>,
    count: usize,
    labels: Vec<String>,
    range: [f64; 2],
    step: f64,
    largest: f64,
}

impl Bars {
    /// Of what a heat map shows.
    pub(crate) fn new(map: &HeatMap<'_>) -> Self {
        let rows = map.rows;
        let values: Vec<f64> = rows.iter().flat_map(|&i| rows.iter().map(move |&j| map.matrix[(i, j)])).collect();
        let low = values.iter().copied().fold(0.0, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        let span = if high > low { high - low } else { 1.0 };
        let step = round_step(span, 5.0);
        let range = [(low / step + 1e-9).floor() * step, ((low + span).max(high) / step - 1e-9).ceil() * step];
        let labels = rows.iter().map(|&i| map.labels[i].clone()).collect();
        let largest = high.max(-low).max(f64::MIN_POSITIVE);
        Self { values, count: rows.len(), labels, range, step, largest }
    }

    fn ruled<'a>(&'a self, unit: &'a str) -> RuledBox<'a> {
        let height = 0.55 * self.count as f32;
        RuledBox { count: self.count, height, values: self.range, step: self.step, labels: &self.labels, unit }
    }

    fn value(&self, [i, j]: [usize; 2]) -> f64 {
        self.values[i * self.count + j]
    }

    /// Two corners of a bar.
    fn body(&self, at: [usize; 2]) -> [Vector3<f32>; 2] {
        let ruled = self.ruled("");
        let [i, j] = at.map(|k| k as f32);
        let n = self.count as f32;
        let (zero, top) = (ruled.height_of(0.0), ruled.height_of(self.value(at)));
        [
            Vector3::new(j + INSET, n - i - 1.0 + INSET, zero.min(top)),
            Vector3::new(j + 1.0 - INSET, n - i - INSET, zero.max(top)),
        ]
    }

    fn cells(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let n = self.count;
        (0..n * n).map(move |k| [k / n, k % n])
    }

    /// All bars that are not zero.
    pub(crate) fn mesh(&self, palette: &Palette) -> Mesh {
        let mut mesh = Mesh::default();
        for at in self.cells().filter(|&at| self.value(at) != 0.0) {
            let [low, high] = self.body(at);
            mesh.cuboid(low, high, palette.diverging((self.value(at) / self.largest) as f32));
        }
        mesh
    }

    /// Row and column of the bar that a ray meets first; else those of the cell at the level of zero.
    pub(crate) fn pick(&self, ray: &Ray) -> Option<[usize; 2]> {
        let met = self.cells().map(|at| {
            let [low, high] = self.body(at);
            (self.value(at) != 0.0).then(|| ray.enters_box(low, high)).flatten()
        });
        if let Some(k) = nearest(met) {
            return Some([k / self.count, k % self.count]);
        }
        let zero = self.ruled("").height_of(0.0);
        let along = (zero - ray.start.z) / ray.direction.z;
        let p = ray.start + ray.direction * along;
        let inside = |v: f32| (0.0..self.count as f32).contains(&v).then_some(v as usize);
        let (j, from_front) = (inside(p.x)?, inside(p.y)?);
        Some([self.count - 1 - from_front, j])
    }

    /// A cell in words: `(7, 9)  −0.1230 N·s/m`.
    pub(crate) fn describe(&self, at: [usize; 2], unit: &str) -> String {
        let [i, j] = at;
        format!("({}, {})  {}", self.labels[i], self.labels[j], format::with_unit(self.value(at), unit))
    }

    fn key(&self, palette: &Palette) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.values.iter().for_each(|v| v.to_bits().hash(&mut hasher));
        palette.canvas.hash(&mut hasher);
        hasher.finish()
    }

    /// The mesh of an earlier frame where nothing has changed.
    fn kept_mesh(&self, ui: &Ui, id: Id) -> Arc<Mesh> {
        let (key, kept) = (self.key(ui.palette()), ui.data(|d| d.get_temp::<(u64, Arc<Mesh>)>(id)));
        if let Some((old, mesh)) = kept
            && old == key
        {
            return mesh;
        }
        let mesh = Arc::new(self.mesh(ui.palette()));
        ui.data_mut(|d| d.insert_temp(id, (key, Arc::clone(&mesh))));
        mesh
    }

    /// Where it stands in `room` as seen by `camera`.
    pub(crate) fn projection(&self, camera: Camera, room: Rect) -> Projection {
        let inner = Rect::from_min_max(room.min + Vec2::new(52.0, 26.0), room.max - Vec2::new(36.0, 40.0));
        Projection::fit(&self.ruled("").corners(), camera, inner)
    }

    /// The faces of a bar that are turned to the eye, as areas on the screen with their outward unit vectors.
    pub(crate) fn faces(&self, at: [usize; 2], p: &Projection) -> Vec<(Vec<egui::Pos2>, Vector3<f32>)> {
        let [low, high] = self.body(at);
        let toward = p.camera.axes()[2];
        let mut faces = Vec::new();
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            if toward[axis].abs() < 1e-4 {
                continue;
            }
            let level = if toward[axis] > 0.0 { high[axis] } else { low[axis] };
            let corner = |a: bool, b: bool| {
                let mut c = Vector3::zeros();
                c[axis] = level;
                c[u] = if a { high[u] } else { low[u] };
                c[v] = if b { high[v] } else { low[v] };
                p.at(c)
            };
            let mut normal = Vector3::zeros();
            normal[axis] = toward[axis].signum();
            let round = vec![corner(false, false), corner(true, false), corner(true, true), corner(false, true)];
            faces.push((round, normal));
        }
        faces
    }

    /// Shows it in the room there is; it is turned with the mouse and the arrow keys. `map` is what it was made of, `title`
    /// that of the exported picture.
    pub(crate) fn show(&self, ui: &mut Ui, title: &str, map: &HeatMap<'_>) {
        let unit = map.unit;
        if !available(ui.ctx()) {
            ui.empty("No graphics adapter", super::paint::NO_ADAPTER);
            return;
        }
        let id = ui.scope_id().with(title);
        let (room, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        let mut camera = ui.data(|d| d.get_temp(id)).unwrap_or(HOME);
        turn(ui, &response, &mut camera, HOME);
        ui.data_mut(|d| d.insert_temp(id, camera));
        let projection = self.projection(camera, room);
        let reach = 2.0 * self.count.max(1) as f32;
        let pretty = format::pretty_unit(unit);
        let ruled = self.ruled(&pretty);
        let hovered = response.hover_pos().and_then(|at| self.pick(&projection.ray(at, reach)));
        let painter = ui.painter_at(room);
        let palette = ui.palette();
        let layer = |draw: &dyn Fn(&mut Drawing)| {
            let mut drawing = Drawing::new(room.size(), palette.canvas, "");
            draw(&mut drawing);
            drawing.paint(&painter, egui::Pos2::ZERO);
        };
        layer(&|d| ruled.back(d, &projection, palette));
        let mesh = self.kept_mesh(ui, id.with("mesh"));
        Solid { id, mesh, projection, viewport: room, reach }.paint(&painter);
        layer(&|d| ruled.rulers(d, &projection, palette, hovered));
        if let Some(at) = hovered {
            for (face, _) in self.faces(at, &projection) {
                painter.add(egui::Shape::closed_line(face, theme::pen(palette.accent)));
            }
            let corner = room.right_top() + Vec2::new(-4.0, 4.0);
            let font = theme::font(theme::size::BODY);
            painter.text(corner, egui::Align2::RIGHT_TOP, tr(self.describe(at, unit)), font, palette.ink);
        }
        response.widget_info(|| {
            let read = hovered.map_or_else(String::new, |at| format!(": {}", self.describe(at, unit)));
            WidgetInfo::labeled(Role::Image, true, tf!("Matrix in 3-D, {pretty}{read}"))
        });
        let paper = |palette: &Palette| self.drawing(title, unit, camera, palette);
        export::offer(ui, &[response], title, &paper, &|| map.table());
    }

    /// The picture as areas: bars from back to front, so that those in front cover those behind.
    fn drawing(&self, title: &str, unit: &str, camera: Camera, palette: &Palette) -> Drawing {
        let mut drawing = Drawing::new(Vec2::new(900.0, 700.0), palette.canvas, title);
        let room = Rect::from_min_max(egui::pos2(20.0, 40.0), egui::pos2(880.0, 690.0));
        let p = self.projection(Camera { zoom: 1.0, ..camera }, room);
        let unit = format::pretty_unit(unit);
        let ruled = self.ruled(&unit);
        drawing.words(egui::pos2(16.0, 20.0), egui::Align2::LEFT_CENTER, title, theme::size::HEADING, palette.ink);
        ruled.back(&mut drawing, &p, palette);
        let mut shown: Vec<[usize; 2]> = self.cells().filter(|&at| self.value(at) != 0.0).collect();
        // Bars on a grid never cross: the distance of their feet orders them.
        let depth = |at: &[usize; 2]| {
            let [low, high] = self.body(*at);
            p.depth(Vector3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), 0.0))
        };
        shown.sort_by(|a, b| depth(a).total_cmp(&depth(b)));
        for at in shown {
            let colour = palette.diverging((self.value(at) / self.largest) as f32);
            for (face, normal) in self.faces(at, &p) {
                let shade = shade(camera, normal);
                let [r, g, b, _] = colour.to_array().map(|c| (f32::from(c) * shade) as u8);
                drawing.area(face, egui::Color32::from_rgb(r, g, b), theme::hair(palette.canvas.gamma_multiply(0.4)));
            }
        }
        ruled.rulers(&mut drawing, &p, palette, None);
        drawing
    }
}

#[cfg(test)]
mod tests {
    use super::{Bars, HOME};
    use crate::plots::heatmap::HeatMap;
    use egui::{Rect, pos2};
    use faer::Mat;
    use nalgebra::Vector3;

    const ROOM: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(600.0, 500.0) };

    fn bars() -> Bars {
        let mut m = Mat::<f64>::zeros(4, 4);
        (m[(0, 0)], m[(2, 2)], m[(3, 3)]) = (1.0, 2.0, 3.5);
        (m[(0, 2)], m[(2, 0)]) = (-0.8, -0.8);
        let labels = ["3", "5", "7", "9"].map(str::to_owned);
        Bars::new(&HeatMap {
            matrix: &m,
            rows: &[0, 2, 3],
            columns: &[0, 2, 3],
            labels: &labels,
            unit: "N s/m",
            scale: None,
        })
    }

    #[test]
    fn heights_are_values_on_a_round_scale() {
        let b = bars();
        assert_eq!((b.range, b.step), ([-1.0, 4.0], 1.0));
        let [low, high] = b.body([2, 2]);
        let ruled = b.ruled("");
        assert!((low.z - ruled.height_of(0.0)).abs() < 1e-6 && (high.z - ruled.height_of(3.5)).abs() < 1e-6);
        let [low, high] = b.body([0, 1]);
        assert!(high.z == ruled.height_of(0.0) && low.z == ruled.height_of(-0.8), "negative values hang");
    }

    #[test]
    fn what_stands_under_the_pointer_is_found() {
        let b = bars();
        let p = b.projection(HOME, ROOM);
        let ray = |v: Vector3<f32>| p.ray(p.at(v), 10.0);
        for at in [[0, 0], [1, 1], [2, 2]] {
            let [low, high] = b.body(at);
            let lid = Vector3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), high.z);
            assert_eq!(b.pick(&ray(lid)), Some(at), "the lid of {at:?}");
        }
        let zero = b.ruled("").height_of(0.0);
        // Row 2 stands in front, column 0 at the left: the cell is empty and nothing hides it.
        assert_eq!(b.pick(&ray(Vector3::new(0.5, 0.5, zero))), Some([2, 0]));
        assert_eq!(b.pick(&p.ray(pos2(2.0, 2.0), 10.0)), None);
        assert_eq!(b.describe([2, 2], "N s/m"), "(9, 9)  3.500 N·s/m");
    }

    #[test]
    fn only_bars_that_are_not_zero_are_drawn() {
        let mesh = bars().mesh(crate::window::appearance::theme::Palette::of(&egui::Visuals::light()));
        assert_eq!(mesh.indices.len(), 5 * 36);
    }
}
