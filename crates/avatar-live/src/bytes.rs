//! Bytes, read one after the other; numbers have their most significant byte first.

use crate::{DecodeError, Found};

/// What is left of a packet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bytes<'a> {
    rest: &'a [u8],
    /// Offset of the rest in the packet.
    at: usize,
}

impl<'a> Bytes<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes, at: 0 }
    }

    /// Bytes that stand at this offset of a packet.
    pub(crate) fn placed(bytes: &'a [u8], at: usize) -> Self {
        Self { rest: bytes, at }
    }

    pub(crate) fn at(&self) -> usize {
        self.at
    }

    pub(crate) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The error that something else should stand here.
    pub(crate) fn wrong(&self, expected: &'static str) -> DecodeError {
        let found = self.rest.first().map_or(Found::End, |byte| Found::Byte(*byte));
        DecodeError::new(self.at, expected, found)
    }

    /// The next bytes.
    pub(crate) fn take(&mut self, count: usize, expected: &'static str) -> Result<&'a [u8], DecodeError> {
        let Some((taken, rest)) = self.rest.split_at_checked(count) else {
            let found = if self.rest.is_empty() { Found::End } else { Found::Bytes(self.rest.len()) };
            return Err(DecodeError::new(self.at, expected, found));
        };
        self.rest = rest;
        self.at += count;
        Ok(taken)
    }

    pub(crate) fn array<const N: usize>(&mut self, expected: &'static str) -> Result<[u8; N], DecodeError> {
        let at = self.at;
        let taken = self.take(N, expected)?;
        taken.try_into().map_err(|_| DecodeError::new(at, expected, Found::Bytes(taken.len())))
    }

    pub(crate) fn byte(&mut self, expected: &'static str) -> Result<u8, DecodeError> {
        self.array(expected).map(|[byte]| byte)
    }

    pub(crate) fn i32(&mut self, expected: &'static str) -> Result<i32, DecodeError> {
        self.array(expected).map(i32::from_be_bytes)
    }

    pub(crate) fn u32(&mut self, expected: &'static str) -> Result<u32, DecodeError> {
        self.array(expected).map(u32::from_be_bytes)
    }

    /// A number that is finite.
    pub(crate) fn f32(&mut self, expected: &'static str) -> Result<f32, DecodeError> {
        let at = self.at;
        let number = f32::from_be_bytes(self.array(expected)?);
        match number.is_finite() {
            true => Ok(number),
            false => Err(DecodeError::new(at, expected, Found::Number(number.into()))),
        }
    }

    /// A text of so many bytes.
    pub(crate) fn text(&mut self, count: usize, expected: &'static str) -> Result<&'a str, DecodeError> {
        let at = self.at;
        let bytes = self.take(count, expected)?;
        std::str::from_utf8(bytes).map_err(|error| {
            let at_error = error.valid_up_to();
            let byte = bytes.get(at_error).copied().unwrap_or_default();
            DecodeError::new(at + at_error, "a text in UTF-8", Found::Byte(byte))
        })
    }
}
