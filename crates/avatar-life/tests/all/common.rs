use crate::face::shape;
use pose_anim::ControlTable;

/// A face of shapes alone.
pub(crate) fn shapes(names: &[&str]) -> ControlTable {
    ControlTable::new(names.iter().map(|name| shape(name)).collect()).unwrap()
}

/// Numbers that look random, the same in each run (PCG by O'Neill 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn share(&mut self) -> f64 {
        let old = self.0;
        self.0 = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let bits = (((old >> 18) ^ old) >> 27) as u32;
        f64::from(bits.rotate_right((old >> 59) as u32)) / 4_294_967_296.0
    }

    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.share()
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.share() * count as f64) as usize).min(count - 1)
    }
}
