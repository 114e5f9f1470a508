use core::net::SocketAddr;

/// How much a sender may say: a bucket that fills at a rate, and from which each packet takes its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bucket {
    left: f64,
    at_secs: f64,
}

/// What an unread packet costs beside its bytes.
const PACKET_COST: f64 = 100.0;
/// What a source may cost in a second, in bytes, and at once. A thousand packets of Live Link Face a second
/// cost half a million.
const COST_A_SECOND: f64 = 4_000_000.0;
const COST_AT_ONCE: f64 = 1_000_000.0;
/// So many sources are known at a time.
const SOURCES: usize = 16;
/// A source that has been silent for so long gives its place to another one.
const SILENT_SECS: f64 = 5.0;

/// Admits packets: each source (address and port) up to a rate, and 16 sources. A flood takes nothing from a
/// source that is heard already; while all places are taken, new ones wait until one falls silent.
#[derive(Clone, Debug)]
pub struct Gate {
    sources: Vec<(SocketAddr, Bucket)>,
}

impl Default for Gate {
    fn default() -> Self {
        Self { sources: Vec::with_capacity(SOURCES) }
    }
}

impl Gate {
    /// Whether a packet of so many bytes, from there and at this time, is to be read.
    pub fn admits(&mut self, now_secs: f64, origin: SocketAddr, bytes: usize) -> bool {
        let cost = PACKET_COST + bytes as f64;
        let known = self.sources.iter().position(|(source, _)| *source == origin);
        let fresh = (origin, Bucket { left: COST_AT_ONCE, at_secs: now_secs });
        let place = known.or_else(|| {
            if self.sources.len() < SOURCES {
                self.sources.push(fresh);
                return Some(self.sources.len() - 1);
            }
            let silent =
                self.sources.iter().position(|(_, bucket)| now_secs - bucket.at_secs > SILENT_SECS)?;
            *self.sources.get_mut(silent)? = fresh;
            Some(silent)
        });
        let Some((_, bucket)) = place.and_then(|place| self.sources.get_mut(place)) else { return false };
        let passed = (now_secs - bucket.at_secs).clamp(0.0, 1.0);
        bucket.left = (bucket.left + passed * COST_A_SECOND).min(COST_AT_ONCE);
        bucket.at_secs = bucket.at_secs.max(now_secs);
        if bucket.left < cost {
            return false;
        }
        bucket.left -= cost;
        true
    }
}
