use crate::cli::RecordArgs;
use crate::clips;
use crate::drafts::Interrupts;
use crate::face_args::FaceChoice;
use crate::film::{FilmSink, FilmTarget, Take, through};
use crate::offscreen::Offscreen;
use crate::progress::Progress;
use crate::script::Script;
use crate::usage::usage;
use anyhow::{Result, bail};

/// More frames than this are a slip of the keyboard, not a wish.
const MAX_FRAMES: u64 = 1_000_000;

/// Seconds of a life that nothing else ends.
const LIFE_SECS: f64 = 10.0;

pub(super) fn run(args: &RecordArgs) -> Result<()> {
    let target =
        FilmTarget::check(&args.out, args.format.as_deref(), args.size, args.fps, args.picture.background.0)?;
    let files = super::open(&args.pack)?;
    let pack = files.load_pack()?;
    let view = args.picture.view(&pack)?;
    let script = args.script.as_deref().map(|script| Script::parse(script, &pack)).transpose()?;
    let clip = args.clip.as_deref().map(|clip| clips::find(&pack, clip)).transpose()?;
    let frames = match (args.duration, &script, &clip) {
        (Some(secs), ..) => args.fps.frames_before(secs),
        (None, Some(script), _) => through(args.fps, script.rest_secs(&pack)?),
        (None, None, Some(clip)) if clip.repeats() => args.fps.frames_before(clip.duration_secs(&pack)),
        (None, None, Some(clip)) => through(args.fps, clip.duration_secs(&pack)),
        (None, None, None) => args.fps.frames_before(LIFE_SECS),
    };
    if frames > MAX_FRAMES {
        return Err(usage(format!(
            "expected at most {MAX_FRAMES} frames, found {frames}: see --duration and --fps"
        )));
    }

    let level = args.lod.level(&pack, &args.look, &view, args.size.sides(), frames);
    let mut offscreen = Offscreen::of_files(&files, &level, args.size, args.picture.samples, args.look)?;
    let interrupts = Interrupts::poll()?;
    let mut film = FilmSink::create(target, args.size, args.fps, frames)?;
    let mut motion = script.as_ref().map(|script| script.motion(&pack));
    let mut progress = Progress::new("frame", frames);
    let (pack, background) = (&pack, args.picture.background.0);
    let take = Take { pack, size: args.size, background, rate: args.fps, frames };
    let mut life = args.life.begin(pack);
    let at = |secs| {
        let face = match (&mut motion, &clip) {
            (Some(motion), _) => FaceChoice::of_values(motion.at(secs)?.values().to_vec()),
            (None, Some(clip)) => FaceChoice::of_found(clip, pack, secs)?,
            (None, None) => FaceChoice::of_values(pack.controls().defaults()),
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
