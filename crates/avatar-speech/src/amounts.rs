/// How much of speech a face shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amounts {
    /// Movements of jaw, lips and tongue, 0 to 1. Lips close at any amount.
    pub mouth: f32,
    /// Movements of the brows with loud syllables, 0 to 1.
    pub brows: f32,
}

impl Default for Amounts {
    fn default() -> Self {
        Self { mouth: 1.0, brows: 1.0 }
    }
}

impl Amounts {
    /// The same within 0 to 1; what is no number is 0.
    pub(crate) fn sound(self) -> Self {
        let sound = |amount: f32| if amount > 0.0 { amount.min(1.0) } else { 0.0 };
        Self { mouth: sound(self.mouth), brows: sound(self.brows) }
    }
}
