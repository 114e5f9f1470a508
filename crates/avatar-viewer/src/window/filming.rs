//! A film of what the window shows, made beside it on a device of its own.

use super::watch::Wake;
use crate::cli::Size;
use crate::clips::FoundClip;
use crate::face_args::FaceChoice;
use crate::film::{FilmSink, FilmTarget, Take, through};
use crate::life_args::Living;
use crate::look_args::LookArgs;
use crate::offscreen::Offscreen;
use crate::speech::Spoken;
use anyhow::{Result, bail};
use avatar_film::{Format, Rate};
use avatar_pack::{Pack, Textures};
use avatar_panel::FilmProgress;
use avatar_stage::{SAMPLES, View};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::Instant;
use winit::event_loop::EventLoopProxy;

/// Frames per second of films from the window; the verb `record` takes any.
const FPS: u32 = 30;
/// Seconds in which the camera goes once around a face that does nothing.
const TURN_SECS: f64 = 4.0;
/// Films of larger windows are that large.
pub(super) const LARGEST_SIDE: u32 = 1920;

/// A film that is being made.
pub(super) struct Filming {
    path: PathBuf,
    frames: u64,
    done: u64,
    started: Instant,
    stop: Arc<AtomicBool>,
    news: Receiver<News>,
    thread: Option<JoinHandle<()>>,
}

impl Drop for Filming {
    /// Closing the window ends the film, and waits until its unfinished file is removed.
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A film that ended by a panic has told so by its silence.
            let _ = thread.join();
        }
    }
}

enum News {
    Done(u64),
    End(Result<()>),
}

/// What is filmed.
pub(super) struct Subject {
    pub(super) pack: Arc<Pack>,
    pub(super) textures: Textures,
    pub(super) look: LookArgs,
    /// The clip; without one the present face is looked at from all around, unless it speaks.
    pub(super) clip: Option<FoundClip>,
    /// What the present face says.
    pub(super) spoken: Option<Spoken>,
    /// How it lives while it speaks.
    pub(super) life: Option<Living>,
    pub(super) values: Vec<f32>,
    pub(super) view: View,
    pub(super) size: Size,
    pub(super) background: [u8; 4],
}

/// Formats of films, for people, with the ends of their names.
pub(super) fn formats() -> Vec<(&'static str, &'static str)> {
    let named = Format::ALL.iter().filter_map(|format| {
        let ending = *format.extensions().first()?;
        Some((if ending == "png" { "animated PNG" } else { ending }, ending))
    });
    named.chain([("PNG frames", "")]).collect()
}

impl Filming {
    pub(super) fn start(subject: Subject, path: PathBuf, window: EventLoopProxy<Wake>) -> Result<Self> {
        let rate = Rate::new(FPS, 1)?;
        let target = FilmTarget::check(&path, None, subject.size, rate, subject.background)?;
        let frames = match (&subject.clip, &subject.spoken) {
            (Some(clip), _) => length(clip, &subject.pack, rate),
            (None, Some(spoken)) => through(rate, spoken.rest_secs()),
            (None, None) => rate.frames_before(TURN_SECS),
        };
        let (sender, news) = channel();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            let tell = |news| {
                let _ = sender.send(news);
                let _ = window.send_event(Wake::Ready);
            };
            let shot = |done| {
                if stopped.load(Ordering::Relaxed) {
                    bail!("stopped after {done} of {frames} frames: nothing was written");
                }
                tell(News::Done(done));
                Ok(())
            };
            tell(News::End(subject.shoot(target, rate, frames, shot)));
        });
        Ok(Self { path, frames, done: 0, started: Instant::now(), stop, news, thread: Some(thread) })
    }

    /// For the panel.
    pub(super) fn progress(&self) -> FilmProgress {
        let secs = self.started.elapsed().as_secs_f64();
        let left = secs / self.done.max(1) as f64 * self.frames.saturating_sub(self.done) as f64;
        FilmProgress {
            done: self.done as usize,
            of: self.frames as usize,
            // What the first frames take says little.
            remaining_secs: (secs > 1.0 && self.done > 1).then_some(left.ceil() as u64),
        }
    }

    /// Whether it is over, and how.
    pub(super) fn take(&mut self) -> Option<Result<()>> {
        loop {
            match self.news.try_recv() {
                Ok(News::Done(done)) => self.done = done,
                Ok(News::End(result)) => return Some(result),
                Err(TryRecvError::Empty) => return None,
                Err(TryRecvError::Disconnected) => {
                    return Some(Err(anyhow::anyhow!("the film has ended early")));
                }
            }
        }
    }
}

fn length(clip: &FoundClip, pack: &Pack, rate: Rate) -> u64 {
    let secs = clip.duration_secs(pack);
    if clip.repeats() { rate.frames_before(secs).max(1) } else { through(rate, secs) }
}

impl Subject {
    fn shoot(
        self,
        target: FilmTarget,
        rate: Rate,
        frames: u64,
        shot: impl FnMut(u64) -> Result<()>,
    ) -> Result<()> {
        let Self { pack, textures, look, clip, mut spoken, mut life, values, view, size, background } = self;
        let mut offscreen = Offscreen::open(&pack, &textures, SAMPLES, look)?;
        let sound = spoken.as_mut().and_then(Spoken::take_sound);
        let mut film = FilmSink::create(target, size, rate, frames, sound)?;
        let at = |secs: f64| match (&clip, &spoken) {
            (Some(clip), _) => Ok((FaceChoice::of_found(clip, &pack, secs)?, view)),
            (None, Some(spoken)) => {
                if let Some(life) = &mut life {
                    life.go_to(secs)?;
                }
                let face = FaceChoice::of_values(values.clone()).speaking(spoken, secs);
                Ok((face.with_life(life.clone()), view))
            }
            (None, None) => {
                let yaw_degrees = view.yaw_degrees + (secs / TURN_SECS * 360.0) as f32;
                Ok((FaceChoice::of_values(values.clone()), View { yaw_degrees, ..view }))
            }
        };
        let take = Take { pack: &pack, size, background, rate, frames };
        take.shoot(&mut offscreen, &mut film, at, shot)?;
        film.finish()
    }
}

impl Filming {
    /// Ends the film and discards what has been written of it.
    pub(super) fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}
