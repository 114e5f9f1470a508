//! Draws egui's triangles on the CPU: the same picture on every machine.

use egui::epaint::{Mesh, Primitive, Vertex};
use egui::{Color32, Rect, TextureId, TexturesDelta};
use egui_kittest::TestRenderer;
use image::{Rgba, RgbaImage};
use std::collections::HashMap;

#[derive(Default)]
pub(crate) struct Canvas {
    textures: HashMap<TextureId, Texture>,
}

struct Texture {
    size: [usize; 2],
    pixels: Vec<Color32>,
}

impl TestRenderer for Canvas {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        let changes = std::mem::take(&mut delta.set);
        for (id, delta) in changes.into_iter().flat_map(|(id, all)| all.into_iter().map(move |one| (id, one)))
        {
            let egui::ImageData::Color(image) = &delta.image;
            let size = image.size;
            match delta.pos {
                None => drop(self.textures.insert(id, Texture { size, pixels: image.pixels.clone() })),
                Some([left, top]) => {
                    let texture = self.textures.get_mut(&id).expect("a texture that is changed is there");
                    for (row, pixels) in image.pixels.chunks(size[0]).enumerate() {
                        let start = (top + row) * texture.size[0] + left;
                        texture.pixels[start..start + size[0]].copy_from_slice(pixels);
                    }
                }
            }
        }
        delta.free.clear();
    }

    fn render(&mut self, ctx: &egui::Context, output: &egui::FullOutput) -> Result<RgbaImage, String> {
        let scale = output.pixels_per_point;
        let size = (ctx.content_rect().size() * scale).round();
        // In place of a face: something to shine through.
        let mut picture = RgbaImage::from_fn(size.x as u32, size.y as u32, |x, y| {
            let (x, y) = (x as f32 / size.x - 0.5, y as f32 / size.y - 0.5);
            // In bands, which make small files.
            let light = 1.0 - ((x * x * 2.5 + y * y * 1.6).sqrt().min(1.0) * 10.0).round() / 10.0;
            let [r, g, b] = [70.0, 58.0, 54.0].map(|ground| (ground + 150.0 * light) as u8);
            Rgba([r, g, b, 255])
        });
        for clipped in ctx.tessellate(output.shapes.clone(), scale) {
            if let Primitive::Mesh(mesh) = clipped.primitive {
                self.mesh(&mut picture, &mesh, clipped.clip_rect * scale, scale);
            }
        }
        Ok(picture)
    }
}

impl Canvas {
    fn mesh(&self, picture: &mut RgbaImage, mesh: &Mesh, clip: Rect, scale: f32) {
        let Some(texture) = self.textures.get(&mesh.texture_id) else { return };
        let clip = [
            clip.left().round().max(0.0),
            clip.top().round().max(0.0),
            clip.right().round().min(picture.width() as f32),
            clip.bottom().round().min(picture.height() as f32),
        ];
        for corners in mesh.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| mesh.vertices[corners[corner] as usize]);
            triangle(picture, texture, corners, clip, scale);
        }
    }
}

fn triangle(picture: &mut RgbaImage, texture: &Texture, corners: [Vertex; 3], clip: [f32; 4], scale: f32) {
    let [mut a, b, mut c] = corners;
    let cross =
        |p: [f32; 2], q: [f32; 2], r: [f32; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let place = |vertex: &Vertex| [vertex.pos.x * scale, vertex.pos.y * scale];
    if cross(place(&a), place(&b), place(&c)) < 0.0 {
        std::mem::swap(&mut a, &mut c);
    }
    let points = [place(&a), place(&b), place(&c)];
    let area = cross(points[0], points[1], points[2]);
    if area <= 0.0 {
        return;
    }
    let low = |axis: usize| points.iter().map(|point| point[axis]).fold(f32::INFINITY, f32::min);
    let high = |axis: usize| points.iter().map(|point| point[axis]).fold(f32::NEG_INFINITY, f32::max);
    let columns = (low(0).max(clip[0]).floor() as u32, high(0).min(clip[2]).ceil().max(0.0) as u32);
    let rows = (low(1).max(clip[1]).floor() as u32, high(1).min(clip[3]).ceil().max(0.0) as u32);
    // A pixel on an edge belongs to one of the two triangles there.
    let inside = |p: [f32; 2], q: [f32; 2], weight: f32| {
        weight > 0.0 || (weight == 0.0 && (q[1] < p[1] || (q[1] == p[1] && q[0] > p[0])))
    };
    for y in rows.0..rows.1 {
        for x in columns.0..columns.1 {
            let at = [x as f32 + 0.5, y as f32 + 0.5];
            let weights = [
                cross(points[1], points[2], at),
                cross(points[2], points[0], at),
                cross(points[0], points[1], at),
            ];
            let covered = inside(points[1], points[2], weights[0])
                && inside(points[2], points[0], weights[1])
                && inside(points[0], points[1], weights[2]);
            if !covered {
                continue;
            }
            let mix = |of: &dyn Fn(&Vertex) -> f32| {
                (weights[0] * of(&a) + weights[1] * of(&b) + weights[2] * of(&c)) / area
            };
            let texel = texture.at(mix(&|v| v.uv.x), mix(&|v| v.uv.y));
            let source: [f32; 4] =
                std::array::from_fn(|band| texel[band] * mix(&|v| f32::from(v.color[band])) / 255.0);
            let pixel = picture.get_pixel_mut(x, y);
            for band in 0..3 {
                let under = f32::from(pixel.0[band]) * (1.0 - source[3] / 255.0);
                pixel.0[band] = (source[band] + under).round().clamp(0.0, 255.0) as u8;
            }
        }
    }
}

impl Texture {
    /// Between the four nearest texels.
    fn at(&self, u: f32, v: f32) -> [f32; 4] {
        let [width, height] = self.size;
        let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
        let texel = |x: f32, y: f32| {
            let column = x.clamp(0.0, width as f32 - 1.0) as usize;
            let row = y.clamp(0.0, height as f32 - 1.0) as usize;
            self.pixels[row * width + column].to_array().map(f32::from)
        };
        let (left, top) = (x.floor(), y.floor());
        let (s, t) = (x - left, y - top);
        let corners =
            [texel(left, top), texel(left + 1.0, top), texel(left, top + 1.0), texel(left + 1.0, top + 1.0)];
        let shares = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
        std::array::from_fn(|band| corners.iter().zip(shares).map(|(texel, share)| texel[band] * share).sum())
    }
}
