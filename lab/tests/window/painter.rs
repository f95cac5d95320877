//! Paints what egui wants on the screen without a graphics card, and to the same pixels on
//! every machine: for pictures of the screen in tests.

use std::collections::HashMap;

use egui::epaint::{ClippedPrimitive, ImageData, Mesh, Primitive, Vertex};
use egui::{Color32, ColorImage, TextureFilter, TextureId, TexturesDelta};
use egui_kittest::TestRenderer;
use kittest_image::{Rgba, RgbaImage};

/// Triangles with a texture, blended over each other.
#[derive(Default)]
pub(crate) struct Painter {
    textures: HashMap<TextureId, (ColorImage, TextureFilter)>,
}

impl TestRenderer for Painter {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        for (id, deltas) in delta.set.drain() {
            for delta in deltas {
                let ImageData::Color(patch) = &delta.image;
                match (delta.pos, self.textures.get_mut(&id)) {
                    (Some([left, top]), Some((whole, _))) => {
                        for (row, line) in patch.pixels.chunks_exact(patch.size[0]).enumerate() {
                            let begin = (top + row) * whole.size[0] + left;
                            whole.pixels[begin..begin + line.len()].copy_from_slice(line);
                        }
                    }
                    _ => {
                        let texture = (patch.as_ref().clone(), delta.options.magnification);
                        self.textures.insert(id, texture);
                    }
                }
            }
        }
        for id in delta.free.drain() {
            self.textures.remove(&id);
        }
    }

    fn render(
        &mut self,
        ctx: &egui::Context,
        output: &egui::FullOutput,
    ) -> Result<RgbaImage, String> {
        let scale = ctx.pixels_per_point();
        let size = ctx.content_rect().size() * scale;
        let mut screen = Screen::new(size.x.round() as usize, size.y.round() as usize);
        for ClippedPrimitive {
            clip_rect,
            primitive,
        } in ctx.tessellate(output.shapes.clone(), scale)
        {
            let Primitive::Mesh(mesh) = primitive else {
                return Err("there is no painter for callbacks".into());
            };
            let texture = self.textures.get(&mesh.texture_id);
            let texture = texture.ok_or_else(|| format!("no texture {:?}", mesh.texture_id))?;
            let clip = [
                clip_rect.min.x * scale,
                clip_rect.min.y * scale,
                clip_rect.max.x * scale,
                clip_rect.max.y * scale,
            ];
            screen.paint(
                &mesh,
                texture,
                clip.map(|edge| edge.round().max(0.0) as usize),
                scale,
            );
        }
        Ok(screen.picture())
    }
}

struct Screen {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

impl Screen {
    fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![[0.0; 3]; width * height],
        }
    }

    fn paint(
        &mut self,
        mesh: &Mesh,
        texture: &(ColorImage, TextureFilter),
        clip: [usize; 4],
        scale: f32,
    ) {
        for corners in mesh.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| mesh.vertices[corners[corner] as usize]);
            self.triangle(corners, texture, clip, scale);
        }
    }

    fn triangle(
        &mut self,
        corners: [Vertex; 3],
        texture: &(ColorImage, TextureFilter),
        clip: [usize; 4],
        scale: f32,
    ) {
        let at = corners.map(|corner| (corner.pos.x * scale, corner.pos.y * scale));
        let area = cross(at[0], at[1], at[2]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let low = |values: [f32; 3]| values.into_iter().fold(f32::MAX, f32::min).floor().max(0.0);
        let high = |values: [f32; 3]| values.into_iter().fold(0.0, f32::max).ceil();
        let (xs, ys) = (at.map(|at| at.0), at.map(|at| at.1));
        let columns =
            (low(xs) as usize).max(clip[0])..(high(xs) as usize).min(clip[2]).min(self.width);
        let rows =
            (low(ys) as usize).max(clip[1])..(high(ys) as usize).min(clip[3]).min(self.height);
        for y in rows {
            for x in columns.clone() {
                let point = (x as f32 + 0.5, y as f32 + 0.5);
                let shares = [
                    cross(at[1], at[2], point) / area,
                    cross(at[2], at[0], point) / area,
                    cross(at[0], at[1], point) / area,
                ];
                // A point on the edge of two triangles belongs to one of them.
                let inside = (0..3).all(|edge| {
                    let (from, to) = (at[(edge + 1) % 3], at[(edge + 2) % 3]);
                    let (dx, dy) = (
                        (to.0 - from.0) * area.signum(),
                        (to.1 - from.1) * area.signum(),
                    );
                    shares[edge] > 0.0 || shares[edge] == 0.0 && (dy < 0.0 || dy == 0.0 && dx > 0.0)
                });
                if inside {
                    let sum = |value: &dyn Fn(&Vertex) -> f32| -> f32 {
                        corners
                            .iter()
                            .zip(shares)
                            .map(|(corner, share)| value(corner) * share)
                            .sum()
                    };
                    let texel = sample(texture, sum(&|it| it.uv.x), sum(&|it| it.uv.y));
                    let channel = |of: usize| {
                        sum(&|it| f32::from(it.color.to_array()[of])) * texel[of] / 255.0
                    };
                    let alpha = channel(3) / 255.0;
                    let pixel = &mut self.pixels[y * self.width + x];
                    for (of, under) in pixel.iter_mut().enumerate() {
                        *under = channel(of) + *under * (1.0 - alpha);
                    }
                }
            }
        }
    }

    fn picture(&self) -> RgbaImage {
        RgbaImage::from_fn(self.width as u32, self.height as u32, |x, y| {
            let [red, green, blue] = self.pixels[y as usize * self.width + x as usize];
            Rgba([red, green, blue, 255.0].map(|value| value.round().clamp(0.0, 255.0) as u8))
        })
    }
}

fn cross(a: (f32, f32), b: (f32, f32), c: (f32, f32)) -> f32 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// The texture at a point, four channels up to 255.
fn sample((image, filter): &(ColorImage, TextureFilter), u: f32, v: f32) -> [f32; 4] {
    let [width, height] = image.size;
    let texel = |x: f32, y: f32| -> Color32 {
        let place = |at: f32, end: usize| (at.max(0.0) as usize).min(end - 1);
        image.pixels[place(y, height) * width + place(x, width)]
    };
    let (x, y) = (u * width as f32, v * height as f32);
    if *filter == TextureFilter::Nearest {
        return texel(x.floor(), y.floor()).to_array().map(f32::from);
    }
    let (x, y) = (x - 0.5, y - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (dx, dy) = (x - left, y - top);
    let four = [
        (texel(left, top), (1.0 - dx) * (1.0 - dy)),
        (texel(left + 1.0, top), dx * (1.0 - dy)),
        (texel(left, top + 1.0), (1.0 - dx) * dy),
        (texel(left + 1.0, top + 1.0), dx * dy),
    ];
    let channel = |of: usize| -> f32 {
        four.iter()
            .map(|(color, share)| f32::from(color.to_array()[of]) * share)
            .sum()
    };
    [0, 1, 2, 3].map(channel)
}
