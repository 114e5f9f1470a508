//! The built-in avatar's skin with hair, and pictures of it.

use avatar_groom::{DensityMap, Groom, RegionStyle, Style};
use avatar_mesh::{Bounds, Mesh};
use avatar_pack::{FaceState, Pack, Source, SourceError, Texture, Textures};
use avatar_render::headless::{Canvas, Gpu};
use avatar_render::{
    AvatarModel, AvatarState, Camera, HairDetail, Image, Light, PartBones, PartDesc, PartTextures, Quality,
    Scene, Style as Manner, linear_from_srgb8,
};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

struct Folder(PathBuf);

impl Source for Folder {
    #[allow(clippy::disallowed_methods, reason = "it reads the built-in avatar")]
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(std::fs::read(self.0.join(name)).ok().map(Cow::Owned))
    }
}

/// Styles of the tests' own, for what measures how hair is drawn: presets may change with fashion.
pub(crate) const CROPPED: Style = Style {
    scalp: RegionStyle {
        length: 0.085,
        length_variation: 0.35,
        bend: 0.6,
        gravity: 0.3,
        comb: [0.5, 0.0, 0.5],
        edge: [0.5, 0.0, 0.5],
        tuck: 0.0,
        parting: 0.03,
        hold: 1.0,
        volume: 0.01,
        clump: 0.35,
        noise: 0.15,
        ..Style::SHORT.scalp
    },
    ..Style::SHORT
};
/// To the chin, behind the ears.
pub(crate) const COMBED_BACK: Style = Style {
    scalp: RegionStyle {
        bend: 2.5,
        gravity: 0.5,
        comb: [0.9, 0.35, -0.75],
        edge: [0.9, 0.35, -0.75],
        tuck: 0.0,
        volume: 0.03,
        ..Style::BOB.scalp
    },
    ..Style::BOB
};
/// The same, to below the neck.
pub(crate) const LONG_BACK: Style =
    Style { scalp: RegionStyle { length: 1.1, parting: 0.0, cut: -0.1, ..COMBED_BACK.scalp }, ..COMBED_BACK };
/// Short curls.
pub(crate) const FRIZZY: Style = Style {
    scalp: RegionStyle {
        length: 0.3,
        bend: 0.6,
        gravity: 0.45,
        comb: [0.6, 0.3, -0.4],
        edge: [0.6, 0.3, -0.4],
        tuck: 0.0,
        curl_radius: 0.024,
        curl_turns: 2.2,
        clump: 0.4,
        ..Style::CURLY.scalp
    },
    ..Style::CURLY
};

/// The built-in avatar and where hair grows on it.
pub(crate) struct Head {
    pub(crate) pack: Pack,
    density: DensityMap,
}

impl Head {
    pub(crate) fn new() -> Self {
        let folder = Folder(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne"));
        let pack = Pack::load(&folder).expect("the built-in avatar");
        let textures = Textures::load(&folder);
        let map = textures.get(Texture::HairDensity).expect("a map of hair");
        let reds = map.as_raw().iter().copied().step_by(4).collect();
        let density = DensityMap::new(map.width(), map.height(), reds).expect("a map");
        Self { pack, density }
    }

    pub(crate) fn skin(&self) -> &Mesh {
        &self.pack.parts()[0].mesh
    }

    /// The box around the head, down to where the sculptor says that shoulders begin: pictures and hair
    /// stay as they are where rows of vertices above that are moved.
    pub(crate) fn head(&self) -> Bounds {
        let mut head = self.pack.head().expect("a head with shoulders");
        head.min.y = -15.4;
        head
    }

    /// The skin with this hair, at bind pose.
    pub(crate) fn with_hair(&self, gpu: &Gpu, style: Style, strands: f32) -> (AvatarModel, AvatarState) {
        self.planted(gpu, self.skin(), style, strands)
    }

    /// The same with another mesh in the place of the skin's.
    pub(crate) fn planted(
        &self,
        gpu: &Gpu,
        skin: &Mesh,
        style: Style,
        strands: f32,
    ) -> (AvatarModel, AvatarState) {
        let part = PartDesc {
            label: "skin",
            mesh: skin,
            first_weight: 0,
            kind: self.pack.parts()[0].kind,
            bones: PartBones::PerVertex,
            textures: PartTextures::default(),
        };
        let mut model =
            AvatarModel::new(&gpu.device, &gpu.queue, &[part], self.pack.palette().len()).expect("a model");
        let eyes: Vec<_> = ["right-eyeball", "left-eyeball"]
            .iter()
            .filter_map(|name| self.pack.part(name)?.mesh.bounds())
            .collect();
        model.set_height(self.head().size().y);
        let groom = Groom::on_head(skin, Some(self.head()), &self.density, &eyes, style, strands, 3);
        model.set_hair(&gpu.device, &gpu.queue, 0, Some(&groom)).expect("hair");
        let state = AvatarState::new(&gpu.device, &model);
        (model, state)
    }

    /// All of the head in the picture, `share` of its height, before a transparent background.
    pub(crate) fn scene(&self, yaw: f32, share: f32) -> Scene {
        let bounds = self.head();
        let fov = 0.4f32;
        let distance = bounds.size().y * 0.5 / (share * (fov * 0.5).tan());
        let camera = Camera::orbit(bounds.center(), distance, yaw, 0.0, fov, 1.0);
        Scene { camera, background: [0.0; 4], light: Light::studio() }
    }
}

/// The weights of the skin's shapes: all that a model of the skin alone has.
pub(crate) fn weights_of_skin<'a>(pack: &Pack, face: &'a FaceState) -> &'a [f32] {
    &face.weights()[pack.parts()[0].shapes()]
}

/// What the adapter at hand does not decide about: low quality.
pub(crate) fn canvas(gpu: &Gpu, size: u32, samples: u32) -> Canvas {
    let shading = Quality::Low.shading(Manner::Natural);
    Canvas::new(gpu, size, size, samples, shading).expect("a canvas")
}

/// All strands as thin as they are.
pub(crate) const PLAIN: HairDetail =
    HairDetail { share: 1.0, is_automatic: false, least_pixels: 0.0, draft: None };

/// Linear light, weighted by alpha, and alpha, pixel by pixel.
pub(crate) fn linear(image: &Image) -> Vec<[f32; 4]> {
    let pixels = image.rgba.chunks_exact(4);
    let of = |p: &[u8]| {
        let alpha = f32::from(p[3]) / 255.0;
        let [r, g, b, _] = linear_from_srgb8([p[0], p[1], p[2], p[3]]);
        [r * alpha, g * alpha, b * alpha, alpha]
    };
    pixels.map(of).collect()
}

/// Means over squares of `factor` by `factor` pixels.
pub(crate) fn shrunk(light: &[[f32; 4]], size: usize, factor: usize) -> Vec<[f32; 4]> {
    let small = size / factor;
    let mut sums = vec![[0.0f32; 4]; small * small];
    for (i, pixel) in light.iter().enumerate() {
        let (x, y) = (i % size / factor, i / size / factor);
        let sum = &mut sums[y * small + x];
        (0..4).for_each(|c| sum[c] += pixel[c] / (factor * factor) as f32);
    }
    sums
}

/// IEC 61966-2-1.
pub(crate) fn encoded(linear: f32) -> f32 {
    let c = linear.clamp(0.0, 1.0);
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// Luminance as displays have it, before grey, 0…255.
pub(crate) fn luma(light: &[[f32; 4]]) -> Vec<f64> {
    let of = |p: &[f32; 4]| {
        let over = |c: usize| p[c] + 0.2 * (1.0 - p[3]);
        255.0 * f64::from(encoded(0.2126 * over(0) + 0.7152 * over(1) + 0.0722 * over(2)))
    };
    light.iter().map(of).collect()
}

/// The structural similarity of two square pictures at each pixel: Z. Wang et al., "Image Quality Assessment:
/// From Error Visibility to Structural Similarity", 2004, over Gaussian windows of 11×11 with a deviation of
/// 1.5.
pub(crate) fn ssim(a: &[f64], b: &[f64], size: usize) -> Vec<f64> {
    let (c1, c2) = ((0.01f64 * 255.0).powi(2), (0.03f64 * 255.0).powi(2));
    let weight = |d: i32| (-0.5 * f64::from(d * d) / (1.5 * 1.5)).exp();
    let last = size as i32 - 1;
    let mut map = Vec::with_capacity(size * size);
    for i in 0..size * size {
        let (x, y) = ((i % size) as i32, (i / size) as i32);
        let [mut total, mut ma, mut mb, mut aa, mut bb, mut ab] = [0.0; 6];
        for (dx, dy) in (-5..=5).flat_map(|dy| (-5..=5).map(move |dx| (dx, dy))) {
            let at = ((y + dy).clamp(0, last) * (last + 1) + (x + dx).clamp(0, last)) as usize;
            let (w, va, vb) = (weight(dx) * weight(dy), a[at], b[at]);
            total += w;
            ma += w * va;
            mb += w * vb;
            aa += w * va * va;
            bb += w * vb * vb;
            ab += w * va * vb;
        }
        let [ma, mb, aa, bb, ab] = [ma, mb, aa, bb, ab].map(|sum| sum / total);
        let (va, vb, cov) = (aa - ma * ma, bb - mb * mb, ab - ma * mb);
        map.push((2.0 * ma * mb + c1) * (2.0 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2)));
    }
    map
}
