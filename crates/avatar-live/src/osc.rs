//! Open Sound Control 1.0: messages, and bundles of them.
//! <https://opensoundcontrol.stanford.edu/spec-1_0.html>
//!
//! Read here rather than by the crate `rosc`, whose recursion through nested bundles has no bound (a datagram
//! of 64 KB nests 3,000 deep) and which allocates for every address and argument.

use crate::bytes::Bytes;
use crate::{DecodeError, Found};

/// Bundles are nested no deeper.
const DEPTH: usize = 8;

/// One argument of a message.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Arg<'a> {
    /// `i`
    Int(i32),
    /// `f`
    Float(f32),
    /// `s`, or `S`
    Text(&'a str),
    /// `b`
    Blob(&'a [u8]),
    /// `h`
    Long(i64),
    /// `d`
    Double(f64),
    /// `t`: seconds since 1900 in 2⁻³²; 1 is now.
    Time(u64),
    /// `c`, `r`, `m`: four bytes with a meaning of their own.
    Four(u8, [u8; 4]),
    /// `T` or `F`
    Bool(bool),
    /// `N`, `I`, `[` or `]`, which have no bytes.
    Mark(u8),
}

impl Arg<'_> {
    /// A number, of whatever type.
    pub fn number(&self) -> Option<f64> {
        match *self {
            Self::Int(number) => Some(number.into()),
            Self::Float(number) => Some(number.into()),
            Self::Double(number) => Some(number),
            Self::Long(number) => Some(number as f64),
            Self::Bool(is_true) => Some(f64::from(u8::from(is_true))),
            _ => None,
        }
    }
}

/// A message.
#[derive(Clone, Copy, Debug)]
pub struct Message<'a> {
    /// Whom it concerns, such as `/VMC/Ext/Blend/Val`.
    pub address: &'a str,
    /// When it is meant, if its bundle says so: seconds since 1900 in 2⁻³².
    pub time: Option<u64>,
    tags: &'a [u8],
    data: Bytes<'a>,
}

impl<'a> Message<'a> {
    /// Its arguments.
    pub fn args(&self) -> Args<'a> {
        Args { tags: self.tags, data: self.data }
    }
}

/// The arguments of a message, one after the other.
#[derive(Clone, Debug)]
pub struct Args<'a> {
    tags: &'a [u8],
    data: Bytes<'a>,
}

impl<'a> Args<'a> {
    /// Finite numbers, as many as asked for; `None` if there are fewer.
    pub fn numbers<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for slot in &mut numbers {
            *slot = self.next()?.number().filter(|number| number.is_finite())?;
        }
        Some(numbers)
    }

    /// A text.
    pub fn text(&mut self) -> Option<&'a str> {
        match self.next()? {
            Arg::Text(text) => Some(text),
            _ => None,
        }
    }
}

impl<'a> Iterator for Args<'a> {
    type Item = Arg<'a>;

    fn next(&mut self) -> Option<Arg<'a>> {
        let (tag, tags) = self.tags.split_first()?;
        // Reading a message has been through all of them: there is no mistake left.
        let arg = arg(*tag, &mut self.data).ok()?;
        self.tags = tags;
        Some(arg)
    }
}

/// Reads a packet and shows its messages one after the other.
///
/// ```
/// let packet = b"/jawOpen\0\0\0\0,f\0\0\x3f\0\0\0";
/// avatar_live::read_osc(packet, &mut |message| {
///     assert_eq!((message.address, message.args().numbers()), ("/jawOpen", Some([0.5])));
/// })?;
/// # Ok::<(), avatar_live::DecodeError>(())
/// ```
///
/// # Errors
/// What is no message and no bundle, texts that do not end or are not in UTF-8, unknown types, bundles that
/// are nested deeper than eight, sizes that are no multiple of four or larger than what is there. Messages
/// before the mistake have been shown.
pub fn read_osc<'a>(packet: &'a [u8], show: &mut dyn FnMut(Message<'a>)) -> Result<(), DecodeError> {
    element(Bytes::new(packet), None, DEPTH, &mut |read| {
        if let Read::Message(message) = read {
            show(message);
        }
        false
    })
}

/// A message: its bytes, and then what they say.
pub(crate) enum Read<'a> {
    Bytes(&'a [u8]),
    Message(Message<'a>),
}

/// As [`read_osc`], but shows the bytes of each message first: where that returns true, it is not read.
pub(crate) fn read_osc_unless<'a>(
    packet: &'a [u8],
    show: &mut dyn FnMut(Read<'a>) -> bool,
) -> Result<(), DecodeError> {
    element(Bytes::new(packet), None, DEPTH, show)
}

fn element<'a>(
    mut bytes: Bytes<'a>,
    time: Option<u64>,
    depth: usize,
    show: &mut dyn FnMut(Read<'a>) -> bool,
) -> Result<(), DecodeError> {
    const START: &str = "an address that begins with /, or #bundle";
    match bytes.rest().first() {
        Some(b'/') if show(Read::Bytes(bytes.rest())) => return Ok(()),
        Some(b'/') => {
            message(bytes, time).map(|message| show(Read::Message(message)))?;
            return Ok(());
        }
        Some(b'#') => {}
        _ => return Err(bytes.wrong(START)),
    }
    let start = bytes;
    if string(&mut bytes)? != "#bundle" {
        return Err(start.wrong(START));
    }
    if depth == 0 {
        return Err(start.wrong("bundles that are nested at most eight deep"));
    }
    let tag = bytes.array("a time tag").map(u64::from_be_bytes)?;
    let time = if tag > 1 { Some(tag) } else { time };
    while !bytes.is_empty() {
        let at = bytes.at();
        let size = bytes.u32("the size of an element")?;
        let size = match usize::try_from(size) {
            Ok(size) if size % 4 == 0 && size <= bytes.rest().len() => size,
            _ => {
                let expected = "a multiple of 4, not more than the rest";
                return Err(DecodeError::new(at, expected, Found::Number(size.into())));
            }
        };
        let at = bytes.at();
        let inner = bytes.take(size, "an element")?;
        element(Bytes::placed(inner, at), time, depth - 1, show)?;
    }
    Ok(())
}

fn message(mut bytes: Bytes<'_>, time: Option<u64>) -> Result<Message<'_>, DecodeError> {
    let address = string(&mut bytes)?;
    // Old senders leave the types out where there are no arguments.
    let tags: &[u8] = match bytes.is_empty() {
        true => &[],
        false => {
            let start = bytes;
            let types = string(&mut bytes)?.as_bytes();
            types.strip_prefix(b",").ok_or_else(|| start.wrong("types of arguments, behind a comma"))?
        }
    };
    let data = bytes;
    for tag in tags {
        arg(*tag, &mut bytes)?;
    }
    if !bytes.is_empty() {
        return Err(bytes.wrong("the end of the message"));
    }
    Ok(Message { address, time, tags, data })
}

fn arg<'a>(tag: u8, bytes: &mut Bytes<'a>) -> Result<Arg<'a>, DecodeError> {
    Ok(match tag {
        b'i' => Arg::Int(bytes.i32("a whole number")?),
        b'f' => Arg::Float(bytes.array("a number").map(f32::from_be_bytes)?),
        b's' | b'S' => Arg::Text(string(bytes)?),
        b'b' => {
            let at = bytes.at();
            let size = bytes.u32("the size of a blob")?;
            let size = usize::try_from(size).unwrap_or(usize::MAX);
            if size > bytes.rest().len() {
                let expected = "a blob not larger than the rest";
                return Err(DecodeError::new(at, expected, Found::Number(size as f64)));
            }
            let blob = bytes.take(size, "a blob")?;
            pad(bytes, size)?;
            Arg::Blob(blob)
        }
        b'h' => Arg::Long(bytes.array("a whole number of 64 bits").map(i64::from_be_bytes)?),
        b'd' => Arg::Double(bytes.array("a number of 64 bits").map(f64::from_be_bytes)?),
        b't' => Arg::Time(bytes.array("a time").map(u64::from_be_bytes)?),
        b'c' | b'r' | b'm' => Arg::Four(tag, bytes.array("four bytes")?),
        b'T' | b'F' => Arg::Bool(tag == b'T'),
        b'N' | b'I' | b'[' | b']' => Arg::Mark(tag),
        _ => {
            let expected = "arguments of the types i f s b h d t c r m T F N I [ ]";
            return Err(DecodeError::new(bytes.at(), expected, Found::Byte(tag)));
        }
    })
}

/// A text that ends with a zero, and zeros up to a multiple of four.
fn string<'a>(bytes: &mut Bytes<'a>) -> Result<&'a str, DecodeError> {
    let Some(length) = bytes.rest().iter().position(|byte| *byte == 0) else {
        let at = bytes.at() + bytes.rest().len();
        return Err(DecodeError::new(at, "a zero at the end of a text", Found::End));
    };
    let text = bytes.text(length, "a text")?;
    bytes.take(1, "a zero")?;
    pad(bytes, length + 1)?;
    Ok(text)
}

/// Zeros up to a multiple of four.
fn pad(bytes: &mut Bytes<'_>, length: usize) -> Result<(), DecodeError> {
    bytes.take((4 - length % 4) % 4, "zeros up to a multiple of 4 bytes").map(drop)
}

/// Writes packets into bytes that the caller owns.
#[derive(Debug)]
pub struct OscWriter<'a> {
    out: &'a mut Vec<u8>,
}

impl<'a> OscWriter<'a> {
    /// Appends to bytes.
    pub fn new(out: &'a mut Vec<u8>) -> Self {
        Self { out }
    }

    /// A message; in a packet of its own, there is only one. Zeros in texts end them.
    pub fn message(&mut self, address: &str, args: &[Arg<'_>]) {
        self.string(address.as_bytes());
        let tags = args.iter().map(|arg| match arg {
            Arg::Int(_) => b'i',
            Arg::Float(_) => b'f',
            Arg::Text(_) => b's',
            Arg::Blob(_) => b'b',
            Arg::Long(_) => b'h',
            Arg::Double(_) => b'd',
            Arg::Time(_) => b't',
            Arg::Bool(true) => b'T',
            Arg::Bool(false) => b'F',
            Arg::Four(tag, _) | Arg::Mark(tag) => *tag,
        });
        let start = self.out.len();
        self.out.push(b',');
        self.out.extend(tags);
        self.out.push(0);
        self.zeros(start);
        for arg in args {
            match arg {
                Arg::Int(number) => self.out.extend(number.to_be_bytes()),
                Arg::Float(number) => self.out.extend(number.to_be_bytes()),
                Arg::Text(text) => self.string(text.as_bytes()),
                Arg::Blob(blob) => {
                    self.out.extend((blob.len() as u32).to_be_bytes());
                    let start = self.out.len();
                    self.out.extend(*blob);
                    self.zeros(start);
                }
                Arg::Long(number) => self.out.extend(number.to_be_bytes()),
                Arg::Double(number) => self.out.extend(number.to_be_bytes()),
                Arg::Time(time) => self.out.extend(time.to_be_bytes()),
                Arg::Four(_, bytes) => self.out.extend(bytes),
                Arg::Bool(_) | Arg::Mark(_) => {}
            }
        }
    }

    /// Begins a bundle, to which everything that follows belongs; 1 as time is now.
    pub fn bundle(&mut self, time: u64) {
        self.string(b"#bundle");
        self.out.extend(time.to_be_bytes());
    }

    /// An element of the bundle: a message, or a bundle of its own.
    pub fn element(&mut self, write: impl FnOnce(&mut OscWriter<'_>)) {
        let start = self.out.len();
        self.out.extend([0; 4]);
        write(&mut OscWriter { out: self.out });
        let size = (self.out.len() - start - 4) as u32;
        if let Some(slot) = self.out.get_mut(start..start + 4) {
            slot.copy_from_slice(&size.to_be_bytes());
        }
    }

    fn string(&mut self, text: &[u8]) {
        let start = self.out.len();
        self.out.extend(text.iter().take_while(|byte| **byte != 0));
        self.out.push(0);
        self.zeros(start);
    }

    /// Zeros up to a multiple of four from where something began.
    fn zeros(&mut self, start: usize) {
        let length = self.out.len() - start;
        self.out.extend(std::iter::repeat_n(0, (4 - length % 4) % 4));
    }
}
