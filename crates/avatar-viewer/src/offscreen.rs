use crate::adapter;
use crate::cli::Size;
use crate::face_args::FaceChoice;
use crate::files::Files;
use crate::look_args::LookArgs;
use anyhow::{Context, Result, bail};
use avatar_groom::{Groom, SEGMENTS};
use avatar_mesh::Deformed;
use avatar_pack::{FaceState, Pack, Texture, Textures};
use avatar_render::headless::{Canvas, Gpu, GpuOptions, RenderImageError, open_blocking};
use avatar_render::{AvatarModel, AvatarState, Deformer, Grower, HairDetail};
use avatar_stage::{View, set_colors, set_groom, upload_with_hair};
use glam::Vec3;
use image::RgbaImage;
use std::sync::OnceLock;
use std::thread;

/// What the device complained about outside of any call, such as running out of memory.
fn check(gpu: &Gpu) -> Result<()> {
    match gpu.errors.take() {
        None => Ok(()),
        Some(error) => bail!("expected adapter {:?} to hold the avatar, found: {error}", gpu.info.name),
    }
}

/// A GPU without a window, holding one avatar.
pub(crate) struct Offscreen {
    gpu: Gpu,
    model: AvatarModel,
    avatar: AvatarState,
    state: FaceState,
    samples: u32,
    look: LookArgs,
    canvas: Option<(Size, Canvas)>,
}

impl Offscreen {
    /// Opens the best adapter and uploads the avatar.
    pub(crate) fn open(pack: &Pack, textures: &Textures, samples: u32, look: LookArgs) -> Result<Self> {
        let gpu = open_blocking(GpuOptions::default()).map_err(adapter::explained)?;
        let hair = look.hair.choose(pack.hair());
        let planted = || hair.as_ref().and_then(|hair| pack.groom(textures, hair));
        Self::upload(gpu, pack, textures, samples, look, planted)
    }

    /// The same with room for pictures of this size, and with those textures of the avatar that will be seen:
    /// they are read while the adapter is opened and what draws is compiled, and hair is planted while they
    /// are uploaded.
    pub(crate) fn of_files(
        files: &Files,
        pack: &Pack,
        size: Size,
        samples: u32,
        look: LookArgs,
    ) -> Result<Self> {
        let hair = look.hair.choose(pack.hair());
        let wanted: Vec<_> = (Texture::DRAWN.into_iter())
            .filter(|texture| !(hair.is_none() && *texture == Texture::HairDensity))
            .collect();
        let read = OnceLock::new();
        let textures = || read.get_or_init(|| files.load_textures(&wanted));
        let plant = || {
            let textures = textures();
            hair.as_ref().and_then(|hair| pack.groom(textures, hair))
        };
        let open = || {
            let gpu = open_blocking(GpuOptions::default()).map_err(adapter::explained)?;
            let canvas = Canvas::new(&gpu, size.width, size.height, samples, look.shading(&gpu.info))?;
            match gpu.errors.take() {
                None => anyhow::Ok((gpu, canvas)),
                Some(reason) => Err(RenderImageError::Device { reason }.into()),
            }
        };
        thread::scope(|scope| {
            let planting = thread::Builder::new().spawn_scoped(scope, plant);
            let opened = open();
            // A system that gives no more threads has this one.
            let planted = || planting.ok().and_then(|planting| planting.join().ok());
            let (gpu, canvas) = match opened {
                Ok(opened) => opened,
                Err(reason) => {
                    // The reason counts, whatever became of the thread.
                    planted();
                    return Err(reason);
                }
            };
            let planted = || planted().unwrap_or_else(plant);
            let uploaded = Self::upload(gpu, pack, textures(), samples, look, planted)?;
            Ok(Self { canvas: Some((size, canvas)), ..uploaded })
        })
    }

    /// `planted` has the hair, and is asked for it when all else is uploaded.
    fn upload(
        gpu: Gpu,
        pack: &Pack,
        textures: &Textures,
        samples: u32,
        look: LookArgs,
        planted: impl FnOnce() -> Option<(usize, Groom)>,
    ) -> Result<Self> {
        let hair = look.hair.choose(pack.hair());
        let (device, queue) = (&gpu.device, &gpu.queue);
        let mut model = upload_with_hair(device, queue, pack, textures, None)?;
        set_colors(queue, pack, &model, &look.colors())?;
        let groom = planted();
        set_groom(device, queue, pack, &mut model, hair.as_ref(), groom.as_ref().map(|(_, groom)| groom))?;
        let mut avatar = AvatarState::new(device, &model);
        avatar.set_hair_detail(look.hair_detail(&gpu.info));
        check(&gpu)?;
        Ok(Self { gpu, model, avatar, state: FaceState::new(pack), samples, look, canvas: None })
    }

    /// Draws hair by so many wide strands, where the quality is one for adapters on which each costs much:
    /// for many small pictures.
    pub(crate) fn sketch_hair(&mut self, strands: u32) {
        let detail = self.look.hair_detail(&self.gpu.info);
        if detail.share < 1.0 {
            self.avatar.set_hair_detail(HairDetail { draft: Some(strands), ..detail });
        }
    }

    /// The adapter, for people.
    pub(crate) fn adapter(&self) -> String {
        let info = &self.gpu.info;
        format!("{} ({:?}, {:?})", info.name, info.backend, info.device_type)
    }

    fn pose(&mut self, pack: &Pack, face: &FaceChoice, after_secs: Option<f64>) -> Result<()> {
        match after_secs {
            Some(secs) => face.apply_after(secs, pack, &mut self.state)?,
            None => face.apply(pack, &mut self.state)?,
        }
        self.avatar.set(&self.gpu.queue, self.state.bones(), self.state.weights())?;
        Ok(())
    }

    /// A picture of the face in this state. `background` is sRGB with straight alpha.
    pub(crate) fn picture(
        &mut self,
        pack: &Pack,
        face: &FaceChoice,
        view: View,
        size: Size,
        background: [u8; 4],
    ) -> Result<RgbaImage> {
        self.frame(pack, face, view, size, background, None)
    }

    /// The same as the next frame of a film, so many seconds after the picture before; `None` for the first.
    pub(crate) fn frame(
        &mut self,
        pack: &Pack,
        face: &FaceChoice,
        view: View,
        size: Size,
        background: [u8; 4],
        after_secs: Option<f64>,
    ) -> Result<RgbaImage> {
        self.pose(pack, face, after_secs)?;
        let canvas = match self.canvas.take_if(|(old, _)| *old == size) {
            Some((_, canvas)) => canvas,
            None => {
                let shading = self.look.shading(&self.gpu.info);
                Canvas::new(&self.gpu, size.width, size.height, self.samples, shading)?
            }
        };
        let view = View { hair_top: self.model.hair_top(), ..view };
        let scene = view.scene(pack, size.aspect(), background, self.look.light());
        let picture = canvas.render(&self.gpu, &scene, &[(&self.model, &self.avatar)])?;
        self.canvas = Some((size, canvas));
        RgbaImage::from_raw(picture.width, picture.height, picture.rgba).context("a whole picture")
    }

    /// The strands, grown on the GPU by the pass that draws, and read back.
    pub(crate) fn strands(&mut self, pack: &Pack, face: &FaceChoice) -> Result<Vec<[Vec3; SEGMENTS + 1]>> {
        self.pose(pack, face, None)?;
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let strands =
            Grower::new(device).run(device, queue, &Deformer::new(device), &self.model, &self.avatar);
        check(&self.gpu)?;
        Ok(strands?)
    }

    /// One part, deformed on the GPU by the function that draws, and read back.
    pub(crate) fn deform(&mut self, pack: &Pack, face: &FaceChoice, part: usize) -> Result<Deformed> {
        self.pose(pack, face, None)?;
        let deformer = Deformer::new(&self.gpu.device);
        let deformed = deformer.run(&self.gpu.device, &self.gpu.queue, &self.model, &self.avatar, part);
        // The device's own words say more than that nothing came back.
        check(&self.gpu)?;
        Ok(deformed?)
    }
}
