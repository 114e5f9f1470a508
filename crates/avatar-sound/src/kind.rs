/// What bytes are that no decoder takes, in words.
pub(crate) fn named(bytes: &[u8]) -> String {
    let begins = |at: usize, with: &[u8]| bytes.get(at..).is_some_and(|rest| rest.starts_with(with));
    let head = bytes.get(..128).unwrap_or(bytes);
    let known = [
        (head.windows(8).any(|part| part == b"OpusHead"), "Opus, which is not read"),
        (begins(4, b"ftyp"), "MP4 (AAC, ALAC or a film), which is not read"),
        (begins(0, &[0x1a, 0x45, 0xdf, 0xa3]), "WebM or Matroska, which is not read"),
        (begins(0, b"FORM") && begins(8, b"AIF"), "AIFF, which is not read"),
        (begins(0, b"#!AMR"), "AMR, which is not read"),
        (begins(0, &[0xff, 0xf1]) || begins(0, &[0xff, 0xf9]), "AAC, which is not read"),
        (begins(0, b"caff"), "CAF, which is not read"),
        (begins(0, b".snd"), "AU, which is not read"),
        (begins(0, b"\x30\x26\xb2\x75"), "WMA, which is not read"),
        (begins(0, b"RIFF") && begins(8, b"WAVE"), "a WAV of a coding that is not read"),
        (begins(0, b"OggS"), "Ogg without Vorbis or FLAC in it"),
        (begins(0, b"fLaC"), "the beginning of a FLAC and no more of it"),
    ];
    if bytes.is_empty() {
        return "an empty file".to_owned();
    }
    if let Some((_, name)) = known.into_iter().find(|(is, _)| *is) {
        return name.to_owned();
    }
    let is_text = |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    if head.iter().all(is_text) {
        return "a text".to_owned();
    }
    let first: Vec<String> = bytes.iter().take(4).map(|byte| format!("{byte:02x}")).collect();
    format!("something else, which begins with the bytes {}", first.join(" "))
}
