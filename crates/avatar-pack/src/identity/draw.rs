use super::Identity;
use avatar_groom::Style;
use avatar_look::Colors;

impl Identity {
    /// Values of all axes for a number: the same on every machine, and mostly mild. Axes that go together in
    /// people do so here (`with`).
    ///
    /// ```
    /// let text = r#"
    ///     [[axis]]
    ///     name = "width"
    ///     less = "narrow"
    ///     more = "wide"
    /// "#;
    /// let identity = avatar_pack::Identity::from_toml(text)?;
    /// assert_eq!(identity.draw(7), identity.draw(7));
    /// assert_ne!(identity.draw(7), identity.draw(8));
    /// # Ok::<(), placed_toml::TomlError>(())
    /// ```
    pub fn draw(&self, seed: u64) -> Vec<f32> {
        let mut state = seed;
        let mut values: Vec<f32> = Vec::with_capacity(self.axes.len());
        for axis in &self.axes {
            let follows = axis.with.iter().map(|(other, share)| share * values.get(*other).unwrap_or(&0.0));
            let value = axis.spread * normal(&mut state) + follows.sum::<f32>();
            values.push(value.clamp(-1.0, 1.0));
        }
        values
    }
}

/// Colours of a person.
pub(crate) struct Drawn {
    pub(crate) colors: Colors,
    pub(crate) hair: [f32; 3],
}

/// Colours for a number: dark skin rarely goes with light eyes and light hair.
pub(crate) fn colors(seed: u64) -> Drawn {
    // Other numbers than those of the axes.
    let mut state = !seed;
    let share = even(&mut state) as f32;
    // Half of the people are below fair to olive, a sixth above brown.
    let melanin = 0.03 + 1.87 * share * share * share * share;
    let mut pick = |dark: &[usize], light: &[usize], certain: f32| {
        let list = if even(&mut state) < f64::from(melanin / certain) { dark } else { light };
        list[((even(&mut state) * list.len() as f64) as usize).min(list.len() - 1)]
    };
    let (iris, hair) =
        (pick(&[0, 0, 0, 0, 1], &[0, 1, 2, 3, 4, 4, 5], 0.5), pick(&[0, 0, 1], &[1, 2, 2, 3, 4, 5, 6], 0.4));
    Drawn {
        colors: Colors { skin: Some(Colors::skin_with(melanin)), iris: Some(Colors::IRISES[iris].1) },
        hair: Style::COLORS[hair].1,
    }
}

/// A number with mean 0 and variance 1, about normally distributed: the sum of twelve even ones. Without
/// logarithms, which differ between platforms.
fn normal(state: &mut u64) -> f32 {
    let sum: f64 = (0..12).map(|_| even(state)).sum();
    (sum - 6.0) as f32
}

/// A number from 0 to 1 by SplitMix64 (Steele, Lea and Flood, 2014).
fn even(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut mixed = *state;
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
