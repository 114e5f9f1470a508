use crate::cli::{FilmArgs, PackArg, RecordArgs, SpeakArgs};
use crate::clips::{self, FoundClip};
use crate::drafts::Interrupts;
use crate::face_args::FaceChoice;
use crate::film::{FilmSink, FilmTarget, Take, through};
use crate::life_args::Living;
use crate::offscreen::Offscreen;
use crate::progress::Progress;
use crate::script::Script;
use crate::speech::Spoken;
use crate::usage::{self, usage};
use anyhow::{Result, bail};
use avatar_pack::Pack;

/// More frames than this are a slip of the keyboard, not a wish.
const MAX_FRAMES: u64 = 1_000_000;

/// Seconds of a life that nothing else ends.
const LIFE_SECS: f64 = 10.0;

/// What moves.
struct Motion {
    /// Where nothing else says a value.
    values: Vec<f32>,
    script: Option<Script>,
    clip: Option<FoundClip>,
    spoken: Option<Spoken>,
    life: Option<Living>,
}

pub(super) fn run(args: &RecordArgs) -> Result<()> {
    shoot(&args.pack, &args.film, |pack| {
        Ok(Motion {
            values: pack.controls().defaults(),
            script: args.script.as_deref().map(|script| Script::parse(script, pack)).transpose()?,
            clip: args.clip.as_deref().map(|clip| clips::find(pack, clip)).transpose()?,
            spoken: Spoken::read(&args.speech, pack)?,
            life: args.life.begin(pack),
        })
    })
}

/// The verb `speak`.
pub(super) fn speak(args: &SpeakArgs) -> Result<()> {
    shoot(&args.pack, &args.film, |pack| {
        let mut values = pack.controls().defaults();
        if let Some(name) = &args.expression {
            let pose = usage::pose(pack, name)?;
            pose.values.iter().for_each(|&(control, value)| values[control] = value);
        }
        let spoken = Spoken::read(&args.speech, pack)?;
        Ok(Motion { values, script: None, clip: None, spoken, life: args.life.begin(pack) })
    })
}

fn shoot(pack: &PackArg, args: &FilmArgs, motion: impl FnOnce(&Pack) -> Result<Motion>) -> Result<()> {
    let target =
        FilmTarget::check(&args.out, args.format.as_deref(), args.size, args.fps, args.picture.background.0)?;
    let files = super::open(pack)?;
    let pack = files.load_pack()?;
    let view = args.picture.view(&pack)?;
    let Motion { values, script, clip, mut spoken, mut life } = motion(&pack)?;
    let of_faces = match (&script, &clip) {
        (Some(script), _) => through(args.fps, script.rest_secs(&pack)?),
        (None, Some(clip)) if clip.repeats() => args.fps.frames_before(clip.duration_secs(&pack)),
        (None, Some(clip)) => through(args.fps, clip.duration_secs(&pack)),
        // Speech ends by itself.
        (None, None) if spoken.is_some() => 1,
        (None, None) => args.fps.frames_before(LIFE_SECS),
    };
    let of_speech = spoken.as_ref().map_or(1, |spoken| through(args.fps, spoken.rest_secs()));
    let frames = args.duration.map_or(of_faces.max(of_speech), |secs| args.fps.frames_before(secs));
    if frames > MAX_FRAMES {
        return Err(usage(format!(
            "expected at most {MAX_FRAMES} frames, found {frames}: see --duration and --fps"
        )));
    }

    let level = args.lod.level(&pack, &args.look, &view, args.size.sides(), frames);
    let mut offscreen = Offscreen::of_files(&files, &level, args.size, args.picture.samples, args.look)?;
    let interrupts = Interrupts::poll()?;
    let sound = spoken.as_mut().and_then(Spoken::take_sound);
    let mut film = FilmSink::create(target, args.size, args.fps, frames, sound)?;
    let mut motion = script.as_ref().map(|script| script.motion(&pack));
    let mut progress = Progress::new("frame", frames);
    let (pack, background) = (&pack, args.picture.background.0);
    let take = Take { pack, size: args.size, background, rate: args.fps, frames };
    let at = |secs| {
        let face = match (&mut motion, &clip) {
            (Some(motion), _) => FaceChoice::of_values(motion.at(secs)?.values().to_vec()),
            (None, Some(clip)) => FaceChoice::of_found(clip, pack, secs)?,
            (None, None) => FaceChoice::of_values(values.clone()),
        };
        let face = match &spoken {
            Some(spoken) => face.speaking(spoken, secs),
            None => face,
        };
        if let Some(life) = &mut life {
            life.go_to(secs)?;
        }
        Ok((face.with_life(life.clone()), view))
    };
    take.shoot(&mut offscreen, &mut film, at, |done| {
        if interrupts.came() {
            bail!("interrupted after {done} of {frames} frames: nothing was written");
        }
        progress.step(done);
        Ok(())
    })?;
    drop(progress);
    film.finish()
}
