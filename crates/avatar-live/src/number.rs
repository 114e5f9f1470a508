//! Numbers of JSON, read from bytes.

/// The number at the beginning of bytes, as JSON writes numbers, and how many bytes it has.
pub(crate) struct Number<'a> {
    text: &'a [u8],
    /// Its digits without the point, and the power of ten that they are multiplied by; `None` where they have
    /// no room.
    decimal: Option<(u64, i32)>,
}

/// Powers of ten that have no error as `f64`.
const EXACT: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// So many digits always have room.
const DIGITS: usize = 19;

impl<'a> Number<'a> {
    /// `None` if no number stands there.
    pub(crate) fn at_start_of(bytes: &'a [u8]) -> Option<Self> {
        let start = usize::from(bytes.first() == Some(&b'-'));
        let mut digits = Digits { bytes, at: start, mantissa: 0 };
        let whole = digits.read();
        // JSON has no zeros before other digits.
        if whole == 0 || (whole > 1 && bytes.get(start) == Some(&b'0')) {
            return None;
        }
        let mut fraction = 0;
        if bytes.get(digits.at) == Some(&b'.') {
            digits.at += 1;
            fraction = digits.read();
            if fraction == 0 {
                return None;
            }
        }
        let Digits { mut at, mantissa, .. } = digits;
        let mut exponent = 0i32;
        if let Some(b'e' | b'E') = bytes.get(at) {
            at += 1;
            let is_negative = bytes.get(at) == Some(&b'-');
            at += usize::from(is_negative || bytes.get(at) == Some(&b'+'));
            let before = at;
            while let Some(digit @ b'0'..=b'9') = bytes.get(at) {
                exponent = exponent.saturating_mul(10).saturating_add(i32::from(digit - b'0'));
                at += 1;
            }
            if at == before {
                return None;
            }
            exponent = if is_negative { -exponent } else { exponent };
        }
        let has_room = whole + fraction <= DIGITS;
        let decimal = has_room.then(|| (mantissa, exponent.saturating_sub(fraction as i32)));
        Some(Self { text: bytes.get(..at)?, decimal })
    }

    /// How many bytes it has.
    pub(crate) fn len(&self) -> usize {
        self.text.len()
    }

    /// The number of this type that is nearest; `None` if it is too large.
    pub(crate) fn to_f64(&self) -> Option<f64> {
        match self.decimal {
            // Both are without error, so their quotient is the nearest number (Clinger 1990).
            Some((digits, power @ -22..=0)) if digits <= 1 << 53 => {
                self.signed(digits as f64 / exact(power)?)
            }
            _ => self.nearest(),
        }
    }

    /// The number of this type that is nearest; `None` if it is too large.
    pub(crate) fn to_f32(&self) -> Option<f32> {
        if let Some((digits, power @ -22..=0)) = self.decimal {
            // Each of the two steps is off by at most half of a unit in the last place of an `f64`. That
            // matters only near the middle between two numbers of `f32`, whose mantissa is 29 bits shorter.
            let number = digits as f64 / exact(power)?;
            let is_clear = (number.to_bits() & 0x1fff_ffff).abs_diff(0x1000_0000) > 4;
            // Below this, `f32` has fewer bits.
            let is_normal = number == 0.0 || number >= f64::from(f32::MIN_POSITIVE);
            if is_clear && is_normal {
                return Some(self.signed(number)? as f32);
            }
        }
        std::str::from_utf8(self.text).ok()?.parse().ok().filter(|number: &f32| number.is_finite())
    }

    fn signed(&self, number: f64) -> Option<f64> {
        Some(if self.text.first() == Some(&b'-') { -number } else { number })
    }

    fn nearest(&self) -> Option<f64> {
        std::str::from_utf8(self.text).ok()?.parse().ok().filter(|number: &f64| number.is_finite())
    }
}

/// Ten to minus this power.
fn exact(power: i32) -> Option<f64> {
    EXACT.get(usize::try_from(-power).ok()?).copied()
}

struct Digits<'a> {
    bytes: &'a [u8],
    at: usize,
    mantissa: u64,
}

impl Digits<'_> {
    /// Reads digits as long as there are some; how many. More than 19 in all wrap.
    fn read(&mut self) -> usize {
        let start = self.at;
        while let Some(eight) = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk()) {
            let Some(value) = eight_digits(*eight) else { break };
            self.mantissa = self.mantissa.wrapping_mul(100_000_000).wrapping_add(value);
            self.at += 8;
        }
        while let Some(digit @ b'0'..=b'9') = self.bytes.get(self.at) {
            self.mantissa = self.mantissa.wrapping_mul(10).wrapping_add(u64::from(digit - b'0'));
            self.at += 1;
        }
        self.at - start
    }
}

/// The value of eight digits, the first of which is the first byte; `None` if one is no digit. All are looked
/// at together, and neighbours joined to numbers of two, four and eight digits.
fn eight_digits(bytes: [u8; 8]) -> Option<u64> {
    let text = u64::from_le_bytes(bytes);
    let values = text ^ 0x3030_3030_3030_3030;
    // A digit's upper half is 0 now, also with 6 added, which lifts ten and more into it.
    if (values | values.wrapping_add(0x0606_0606_0606_0606)) & 0xf0f0_f0f0_f0f0_f0f0 != 0 {
        return None;
    }
    let two = (values * 10 + (values >> 8)) & 0x00ff_00ff_00ff_00ff;
    let four = (two * 100 + (two >> 16)) & 0x0000_ffff_0000_ffff;
    Some((four * 10_000 + (four >> 32)) & 0xffff_ffff)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As [`Number`] reads it, and as Rust does.
    fn check(text: &str) {
        let followed = format!("{text},\"x\"");
        let number = Number::at_start_of(followed.as_bytes()).unwrap();
        assert_eq!(number.len(), text.len(), "{text}");
        let expected: f64 = text.parse().unwrap();
        let expected = Some(expected).filter(|number| number.is_finite());
        assert_eq!(number.to_f64().map(f64::to_bits), expected.map(f64::to_bits), "{text}");
        let expected: f32 = text.parse().unwrap();
        let expected = Some(expected).filter(|number| number.is_finite());
        assert_eq!(number.to_f32().map(f32::to_bits), expected.map(f32::to_bits), "{text}");
        // What reads a line for itself.
        let read = serde_json::from_str::<f32>(text).ok();
        assert_eq!(number.to_f32().map(f32::to_bits), read.map(f32::to_bits), "{text}");
    }

    #[test]
    fn numbers_are_those_that_rust_reads() {
        for text in [
            "0",
            "-0",
            "0.0",
            "7",
            "12",
            "-12.5",
            "1e3",
            "1E+3",
            "1e-3",
            "12345678",
            "123456789",
            "1e400",
            "0e999",
            "9007199254740993",
            "18446744073709551615",
            "18446744073709551616",
            "99999999999999999999",
            "1e-400",
            "0.000000000000000000000000000000000000000000001",
            "1.17549435e-38",
            "3.4028236e38",
            "0.1234567890123456789",
            // In the middle between two numbers of f32.
            "1.00000005960464477539",
            "0.5000000298023223877",
            "0.2500000149011611939",
            "3.5e38",
            "340282350000000000000000000000000000000",
            "0.50000002980232238769",
            "1.000000059604644775390625",
        ] {
            check(text);
        }
        // Splitmix64, for numbers of all lengths.
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ z >> 31
        };
        for _ in 0..200_000 {
            let single = f32::from_bits(random() as u32);
            if single.is_finite() {
                check(&format!("{single}"));
                check(&format!("{}", f64::from(single)));
                check(&format!("{single:e}"));
                // The middle to its neighbour, and a trace beside it.
                let middle = (f64::from(single) + f64::from(single.next_up())) / 2.0;
                if middle.is_finite() && middle.abs() < 1e6 {
                    check(&format!("{middle:.19}"));
                    check(&format!("{}", middle.next_up()));
                }
            }
            check(&format!("{}", random() >> (random() % 64)));
            check(&format!("0.{:0width$}", random() >> (random() % 64), width = random() as usize % 24));
        }
    }

    #[test]
    fn what_json_does_not_write_is_no_number() {
        for text in
            ["", "-", "x", "+1", ".5", "-.5", "1.", "1.e5", "1e", "1e+", "01", "-00", "00.5", "inf", "NaN"]
        {
            assert!(Number::at_start_of(text.as_bytes()).is_none(), "{text}");
        }
    }
}
