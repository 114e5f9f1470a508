//! A part on the GPU: geometry and looks.

use crate::gpu::bindings::{sampler_entry, texture_binding, texture_entry, uniform_entry};
use crate::gpu::image::Image;
use crate::gpu::texture::{TextureUse, Textures};
use crate::model::desc::{PartBones, PartDesc};
use crate::model::effects::Effects;
use crate::model::error::PartProblem;
use crate::model::eye::{EyeShape, eye_shape};
use crate::model::finish::{Finish, FinishCell};
use crate::model::geometry::Geometry;
use crate::model::material::{
    COLOR_TEXTURE, EMISSIVE_TEXTURE, GLOSS_TEXTURE, GpuMaterial, METALLIC_ROUGHNESS_TEXTURE, NORMAL_TEXTURE,
    OCCLUSION_TEXTURE, SHADE_TEXTURE, THICKNESS_TEXTURE, WRINKLE_TEXTURE,
};
use avatar_look::{Material, ToneMap, Wrap, Wrinkle};
use avatar_mesh::{Bounds, PartKind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use wgpu::util::DeviceExt;

/// A part on the GPU.
#[derive(Debug)]
pub(crate) struct ModelPart {
    pub(crate) label: String,
    pub(crate) kind: PartKind,
    pub(crate) geometry: Geometry,
    pub(crate) look: wgpu::BindGroup,
    /// How it is drawn if it looks as an interchange file says.
    pub(crate) finish: FinishCell,
    /// Whether its skin or iris has another colour than it is painted in.
    is_recolored: AtomicBool,
    material: wgpu::Buffer,
    textures: u32,
    eye: Option<EyeShape>,
    /// Where which shapes wrinkle it.
    pub(crate) wrinkles: Arc<[Wrinkle]>,
}

/// The cornea that moves with an eyeball.
fn cornea_of<'a, 'b>(ball: &PartDesc<'b>, parts: &'a [PartDesc<'b>]) -> Option<&'a PartDesc<'b>> {
    let is_its_cornea = |part: &&PartDesc<'_>| part.kind == PartKind::Cornea && part.bones == ball.bones;
    let center = ball.mesh.bounds()?.center();
    let distance = |part: &PartDesc<'_>| {
        part.mesh.bounds().map_or(f32::INFINITY, |bounds| bounds.center().distance(center))
    };
    match (ball.kind, ball.bones) {
        // Refraction turns the view back to bind pose with the eye's one bone: eyes with bones per vertex are
        // drawn without it.
        (PartKind::Eyeball, PartBones::Rigid(_)) => {
            parts.iter().filter(is_its_cornea).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        }
        _ => None,
    }
}

/// The height of the skin, or of everything where there is no skin; never 0. Heads with shoulders say theirs.
pub(crate) fn height(parts: &[PartDesc<'_>]) -> f32 {
    let bounds = |skin_only: bool| {
        parts
            .iter()
            .filter(|part| !skin_only || part.kind == PartKind::Skin)
            .filter_map(|part| part.mesh.bounds())
            .reduce(Bounds::union)
    };
    let height = bounds(true).or_else(|| bounds(false)).map_or(0.0, |bounds| bounds.size().y);
    if height > 0.0 { height } else { 1.0 }
}

/// The layouts of the groups that every part has.
#[derive(Debug)]
pub(crate) struct PartLayouts {
    geometry: wgpu::BindGroupLayout,
    looks: wgpu::BindGroupLayout,
}

impl PartLayouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self { geometry: Geometry::layout(device), looks: look_layout(device) }
    }
}

/// Layout of group 2 of the passes that draw parts: their looks.
pub(crate) fn look_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let texture = |binding| {
        let filtered = wgpu::TextureSampleType::Float { filterable: true };
        texture_entry(binding, wgpu::ShaderStages::FRAGMENT, filtered, wgpu::TextureViewDimension::D2)
    };
    let sampler =
        |binding| sampler_entry(binding, wgpu::ShaderStages::FRAGMENT, wgpu::SamplerBindingType::Filtering);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("part looks"),
        entries: &[
            uniform_entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT),
            texture(1),
            texture(2),
            texture(3),
            texture(4),
            texture(5),
            sampler(6),
            sampler(7),
            sampler(8),
            sampler(9),
            sampler(10),
            texture(11),
        ],
    })
}

fn address_mode(wrap: Wrap) -> wgpu::AddressMode {
    match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
    }
}

impl ModelPart {
    /// Uploads one of `parts`. `height` is that of the skin; `known` are the textures of parts before.
    #[allow(clippy::too_many_arguments, reason = "what one part needs, and what all parts of a model share")]
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layouts: &PartLayouts,
        known: &mut Textures,
        desc: &PartDesc<'_>,
        parts: &[PartDesc<'_>],
        palette_len: usize,
        height: f32,
    ) -> Result<Self, PartProblem> {
        let label = desc.label;
        let geometry = Geometry::new(device, &layouts.geometry, desc, palette_len)?;
        let eye = cornea_of(desc, parts).and_then(|cornea| eye_shape(cornea.mesh, desc.mesh));
        // Bound instead of a missing texture; shaders do not sample it.
        let blank = Image { width: 1, height: 1, rgba: vec![255; 4] };
        let mut textures = 0;
        let mut view = |bit: u32, which: &'static str, image: Option<&Image>, usage: TextureUse| {
            textures |= if image.is_some() { bit } else { 0 };
            let label = format!("{label}: {which}");
            known
                .upload(device, queue, &label, image.unwrap_or(&blank), usage)
                .map_err(|error| PartProblem::Texture { which, error })
        };
        let pictures = &desc.textures;
        let gloss = match (pictures.shade, pictures.metallic_roughness) {
            (Some(_), _) => view(SHADE_TEXTURE, "shade", pictures.shade, TextureUse::Color)?,
            (None, Some(_)) => {
                let picture = pictures.metallic_roughness;
                view(METALLIC_ROUGHNESS_TEXTURE, "metallic roughness", picture, TextureUse::Normal)?
            }
            (None, None) => view(GLOSS_TEXTURE, "gloss", pictures.gloss, TextureUse::Value)?,
        };
        let thickness = match pictures.emissive {
            Some(_) => view(EMISSIVE_TEXTURE, "emissive", pictures.emissive, TextureUse::Color)?,
            None => view(THICKNESS_TEXTURE, "thickness", pictures.thickness, TextureUse::Value)?,
        };
        let views = [
            view(COLOR_TEXTURE, "color", desc.textures.color, TextureUse::Color)?,
            view(OCCLUSION_TEXTURE, "occlusion", desc.textures.occlusion, TextureUse::Value)?,
            gloss,
            view(NORMAL_TEXTURE, "normal", desc.textures.normal, TextureUse::Normal)?,
            thickness,
            view(WRINKLE_TEXTURE, "wrinkles", pictures.wrinkles.map(|own| own.depths), TextureUse::Value)?,
        ];
        let gpu_material =
            GpuMaterial::new(&Material::of(desc.kind), desc.kind, &geometry, eye.as_ref(), height, textures);
        let material = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(&format!("{label}: material")),
            contents: bytemuck::bytes_of(&gpu_material),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        });
        let wraps = pictures.wraps;
        // A slot that several textures may have wraps like the one that has it.
        let gloss_wrap = if pictures.shade.is_some() { wraps.shade } else { wraps.metallic_roughness };
        let samplers = [wraps.color, wraps.occlusion, gloss_wrap, wraps.normal, wraps.emissive]
            .map(|wrap| known.sampler(device, wrap.map(address_mode)));
        let sampler = |binding, place: usize| wgpu::BindGroupEntry {
            binding,
            resource: wgpu::BindingResource::Sampler(&samplers[place]),
        };
        let look = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&format!("{label}: looks")),
            layout: &layouts.looks,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: material.as_entire_binding() },
                texture_binding(1, &views[0]),
                texture_binding(2, &views[1]),
                texture_binding(3, &views[2]),
                texture_binding(4, &views[3]),
                texture_binding(5, &views[4]),
                sampler(6, 0),
                sampler(7, 1),
                sampler(8, 2),
                sampler(9, 3),
                sampler(10, 4),
                texture_binding(11, &views[5]),
            ],
        });
        let (label, kind, finish) = (label.to_owned(), desc.kind, FinishCell::default());
        let is_recolored = AtomicBool::new(gpu_material.is_recolored());
        let places = pictures.wrinkles.map_or(&[][..], |wrinkles| wrinkles.places);
        let wrinkles = places.iter().take(Wrinkle::MOST).cloned().collect();
        Ok(Self { label, kind, geometry, look, finish, is_recolored, material, textures, eye, wrinkles })
    }

    /// Whether it is drawn as this kind of part of a face, not as its file says.
    pub(crate) fn is_face_part(&self, kind: PartKind) -> bool {
        self.kind == kind && self.finish.get().is_none()
    }

    /// Whether it is blended over what is behind.
    pub(crate) fn is_blended(&self) -> bool {
        self.kind == PartKind::Cornea || self.finish.get().is_some_and(Finish::is_blended)
    }

    /// What has to be shown of it where shapes wrinkle the avatar, or where they do not.
    pub(crate) fn effects(&self, is_wrinkled: bool, tone_map: ToneMap) -> Effects {
        Effects {
            has_agx: tone_map == ToneMap::AgX,
            has_grooves: is_wrinkled && self.textures & WRINKLE_TEXTURE != 0,
            is_recolored: self.is_recolored.load(Ordering::Relaxed),
        }
    }

    /// Replaces the looks, from the next submission on.
    pub(crate) fn set_material(&self, queue: &wgpu::Queue, material: &Material, height: f32) {
        let gpu =
            GpuMaterial::new(material, self.kind, &self.geometry, self.eye.as_ref(), height, self.textures);
        queue.write_buffer(&self.material, 0, bytemuck::bytes_of(&gpu));
        self.finish.set(self.kind, material);
        self.is_recolored.store(gpu.is_recolored(), Ordering::Relaxed);
    }
}
