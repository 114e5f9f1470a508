use crate::cli::LiveArgs;
use crate::drafts::Interrupts;
use crate::ending;
use crate::live::{CalibrationFile, Follow, Inbox, Recorder, Sending, Take, line};
use crate::live_args::LiveOptions;
use crate::output::{Contents, OutputFile};
use crate::standard;
use crate::usage::usage;
use anyhow::{Context, Result};
use avatar_pack::Pack;
use clap::ArgMatches;
use std::io::Write;

/// Seconds after the end of a recording, in which the face comes to rest.
const AFTER_SECS: f64 = 0.5;

pub(super) fn run(args: &LiveArgs, matches: &ArgMatches) -> Result<()> {
    let LiveArgs { window, live: args } = args;
    if !args.headless {
        return crate::window::run_live(window, matches, args);
    }
    let take = args.record.as_deref().map(Take::check).transpose()?;
    let trace = args.trace.as_deref().map(|path| {
        ending::format(path, None, &[("csv", ())], "").context("--trace")?;
        OutputFile::check(path, Contents::Text)
    });
    let trace = trace.transpose()?;
    let files = super::open(&window.pack)?;
    let pack = files.load_pack()?;
    let mut values = pack.controls().defaults();
    window.face.resolve(&pack, matches)?.start_values().clone_into(&mut values);
    let inbox = Inbox::open(&args.listen, crate::live::Pages::new(&args.page), || {})?;
    let mut follow = Follow::new(&pack, inbox, args.smooth, args.calibrate, args.mirror);
    if let Some(path) = &args.play {
        follow.play(path, 0.0)?;
    }
    let kept = CalibrationFile::of(args.calibration.as_deref(), |name| files.kept(name));
    if let Some(kept) = &kept {
        follow.receiver.set_calibration(&kept.read()?);
    }
    let seconds = match (args.seconds, &args.play) {
        (Some(seconds), _) => seconds,
        (None, Some(_)) => follow.tape_secs() + AFTER_SECS,
        (None, None) => return Err(usage("expected --seconds with --headless --listen, found none")),
    };
    let mut recorder = take.as_ref().map(|_| Recorder::new(args.hz));
    let mut sending = args.send.as_ref().map(|to| Sending::new(&to.0)).transpose()?;
    follow.places().for_each(standard::tell);
    let mut run = |out: &mut dyn Write| {
        Run { args, seconds, pack: &pack }.go(&mut follow, &mut values, out, |follow, secs| {
            if let Some(recorder) = &mut recorder {
                recorder.add(follow.receiver.face());
            }
            if let Some(sending) = &mut sending {
                sending.send(follow, secs);
            }
        })
    };
    match &trace {
        Some(trace) => trace.stream(run)?,
        None => run(&mut std::io::sink())?,
    }
    if let (Some(kept), Some(calibration)) = (&kept, follow.calibrated()) {
        kept.write(&calibration)?;
    }
    for sender in follow.receiver.senders() {
        standard::tell(line(&sender));
    }
    if let Some((count, refused)) = follow.refused {
        standard::tell(format_args!("{count} packets were not used; the last one: {refused}"));
    }
    match (&take, &recorder) {
        (Some(take), Some(recorder)) => take.write(recorder, &pack),
        _ => Ok(()),
    }
}

struct Run<'a> {
    args: &'a LiveOptions,
    seconds: f64,
    pack: &'a Pack,
}

impl Run<'_> {
    fn go(
        &self,
        follow: &mut Follow,
        values: &mut [f32],
        out: &mut dyn Write,
        mut each: impl FnMut(&Follow, f64),
    ) -> Result<()> {
        super::trace::header(self.pack, &[""], out)?;
        let interrupts = Interrupts::poll()?;
        // A recording alone needs no clock.
        let waits = !self.args.listen.is_empty();
        let mut row = 0u64;
        loop {
            let secs = row as f64 / self.args.hz;
            // The product may lie a rounding error below a whole number of ticks.
            if secs > self.seconds * (1.0 + 1e-12) || interrupts.came() {
                return Ok(());
            }
            if waits {
                follow.wait(secs);
            }
            follow.advance(secs)?;
            follow.apply(values);
            super::trace::row(secs, &*values, out)?;
            each(follow, secs);
            row += 1;
        }
    }
}
