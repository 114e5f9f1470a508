use crate::{LANES, Lanes};
use pulp::{Simd, bytemuck};
use std::ops::{Add, Div, Mul, Sub};

/// How many [`Wide`] make a [`Lanes`].
#[inline(always)]
pub const fn steps<S: Simd>() -> usize {
    LANES / S::F32_LANES
}

/// How many [`Wide64`] make a [`Lanes`].
#[inline(always)]
pub const fn steps64<S: Simd>() -> usize {
    LANES / S::F64_LANES
}

/// A vector of numbers of 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct Wide<S: Simd> {
    simd: S,
    numbers: S::f32s,
}

/// A vector of numbers of 64 bits.
#[derive(Clone, Copy, Debug)]
pub struct Wide64<S: Simd> {
    simd: S,
    numbers: S::f64s,
}

impl<S: Simd> Wide<S> {
    /// The same number everywhere.
    #[inline(always)]
    pub fn splat(simd: S, value: f32) -> Self {
        Self { simd, numbers: simd.splat_f32s(value) }
    }

    /// The numbers of one step, which is below [`steps`].
    #[inline(always)]
    pub fn load(simd: S, lanes: &Lanes, step: usize) -> Self {
        Self { simd, numbers: S::as_simd_f32s(&lanes.0).0[step] }
    }

    /// Writes the numbers to their step, which is below [`steps`].
    #[inline(always)]
    pub fn store(self, lanes: &mut Lanes, step: usize) {
        S::as_mut_simd_f32s(&mut lanes.0).0[step] = self.numbers;
    }

    /// `yes` where `self < limit`, else `no`.
    #[inline(always)]
    pub fn below(self, limit: Self, yes: Self, no: Self) -> Self {
        let mask = self.simd.less_than_f32s(self.numbers, limit.numbers);
        Self { numbers: self.simd.select_f32s(mask, yes.numbers, no.numbers), ..self }
    }

    /// `yes` where this bit is set in the representation of the number, else `no`.
    #[inline(always)]
    pub fn bit(self, bit: u32, yes: Self, no: Self) -> Self {
        let simd = self.simd;
        let one = simd.splat_u32s(1 << bit);
        let mask = simd.equal_u32s(simd.and_u32s(simd.transmute_u32s_f32s(self.numbers), one), one);
        Self { numbers: simd.select_f32s(mask, yes.numbers, no.numbers), ..self }
    }

    /// `yes` where `self == other`, else `no`.
    #[inline(always)]
    pub fn equal(self, other: Self, yes: Self, no: Self) -> Self {
        let mask = self.simd.equal_f32s(self.numbers, other.numbers);
        Self { numbers: self.simd.select_f32s(mask, yes.numbers, no.numbers), ..self }
    }

    /// Where `self == other`: bit k for number k of the vector.
    #[inline(always)]
    pub fn equal_bits(self, other: Self) -> u32 {
        let mask = self.simd.equal_f32s(self.numbers, other.numbers);
        // A mask is a bit for each number in an integer, or a whole number of bits that are all alike.
        match const { size_of::<S::m32s>() } {
            1 => bytemuck::cast::<_, u8>(mask).into(),
            2 => bytemuck::cast::<_, u16>(mask).into(),
            _ => {
                let numbers: &[u32] = bytemuck::cast_slice(std::slice::from_ref(&mask));
                numbers.iter().enumerate().fold(0, |bits, (lane, number)| bits | (number & 1) << lane)
            }
        }
    }

    /// The square root, rounded as [`f32::sqrt`].
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self { numbers: self.simd.sqrt_f32s(self.numbers), ..self }
    }

    /// The number, not below `min` and not above `max`; NaN stays NaN.
    #[inline(always)]
    pub fn clamp(self, min: Self, max: Self) -> Self {
        let raised = self.below(min, min, self);
        max.below(raised, max, raised)
    }
}

impl<S: Simd> Wide64<S> {
    /// The same number everywhere.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { simd, numbers: simd.splat_f64s(value) }
    }

    /// The numbers of one step, which is below [`steps64`].
    #[inline(always)]
    pub fn load(simd: S, lanes: &Lanes<f64>, step: usize) -> Self {
        Self { simd, numbers: S::as_simd_f64s(&lanes.0).0[step] }
    }

    /// Writes the numbers to their step, which is below [`steps64`].
    #[inline(always)]
    pub fn store(self, lanes: &mut Lanes<f64>, step: usize) {
        S::as_mut_simd_f64s(&mut lanes.0).0[step] = self.numbers;
    }

    /// `yes` where `self < limit`, else `no`.
    #[inline(always)]
    pub fn below(self, limit: Self, yes: Self, no: Self) -> Self {
        let mask = self.simd.less_than_f64s(self.numbers, limit.numbers);
        Self { numbers: self.simd.select_f64s(mask, yes.numbers, no.numbers), ..self }
    }

    /// The number, not below `min` and not above `max`; NaN stays NaN.
    #[inline(always)]
    pub fn clamp(self, min: Self, max: Self) -> Self {
        let raised = self.below(min, min, self);
        max.below(raised, max, raised)
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $f32s:ident, $f64s:ident) => {
        impl<S: Simd> $trait for Wide<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { numbers: self.simd.$f32s(self.numbers, other.numbers), ..self }
            }
        }

        impl<S: Simd> $trait for Wide64<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { numbers: self.simd.$f64s(self.numbers, other.numbers), ..self }
            }
        }
    };
}

operator!(Add, add, add_f32s, add_f64s);
operator!(Sub, sub, sub_f32s, sub_f64s);
operator!(Mul, mul, mul_f32s, mul_f64s);
operator!(Div, div, div_f32s, div_f64s);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Work;

    struct Bits<'a>(&'a Lanes, &'a Lanes);

    impl Work for Bits<'_> {
        type Output = u32;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> u32 {
            (0..steps::<S>()).fold(0, |bits, step| {
                let own = Wide::load(simd, self.0, step).equal_bits(Wide::load(simd, self.1, step));
                bits | own << (step * S::F32_LANES)
            })
        }
    }

    #[test]
    fn equal_lanes_are_told_by_a_bit_each() {
        let numbers =
            Lanes([0.0, -0.0, 1.0, f32::NAN, 2.0, 0.0, 7.0, -7.0, 8.0, 9.0, 0.0, 3.0, 3.0, 3.0, 4.0, 0.0]);
        for other in [0.0, 3.0, 8.0, f32::NAN, 5.0] {
            let expected = (0..LANES).fold(0, |bits, k| bits | u32::from(numbers[k] == other) << k);
            let others = Lanes::splat(other);
            assert_eq!(crate::run(Bits(&numbers, &others)), expected, "{other}");
            assert_eq!(Bits(&numbers, &others).with_simd(pulp::Scalar), expected, "{other}, one by one");
        }
    }
}
