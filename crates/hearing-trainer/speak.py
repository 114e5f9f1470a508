#!/usr/bin/env python3
"""Lets Debian's speech synthesisers read texts.txt, and writes what they say with what each sound looks like.

    speak.py FOLDER

writes FOLDER/train, FOLDER/test, FOLDER/noise (the test with pink noise, 10 dB below the voice), FOLDER/silence and
FOLDER/music: NAME.wav, and NAME.vis with one sound a line: begin and end in seconds, and
the viseme's number (0 sil, PP, FF, TH, DD, kk, CH, SS, nn, RR, aa, E, ih, oh, ou), or -1 where the label does not
tell it. Needs python3 and the packages espeak-ng, sox, flite, festival, festvox-kallpc16k,
festvox-kdlpc16k, festvox-italp16k,
festvox-itapc16k, festvox-ca-ona-hts, festvox-czech-{dita,krb,machac,ph}, festvox-suopuhe-{lj,mv}, festvox-ru,
festvox-us-slt-hts. Voices of "test" are in no training.
"""
import array, ctypes, os, random, re, struct, subprocess, sys, unicodedata, wave

SIL, PP, FF, TH, DD, KK, CH, SS, NN, RR, AA, E, IH, OH, OU = range(15)

SIGNS = {}
for viseme, signs in [
    (PP, "pbmɓɸβ"), (FF, "fvɱʋ"), (TH, "θð"), (DD, "tdʈɖɗɾ"), (KK, "kgɡŋxɣχqɢcɟçʝʁʀɰ"), (CH, "ʃʒɕʑʂʐʧʤ"),
    (SS, "szʦʣ"), (NN, "nlɳɲɭʎɫ"), (RR, "rɹɻɽɝɚ"), (AA, "aɑɐɒæʌäɶ"), (E, "eɛəɘɜɤᵊ"), (IH, "iɪɨjᵻɯ"),
    (OH, "oɔøœɵɞ"), (OU, "uʊʉyʏwɥʍ"),
]:
    for sign in signs:
        SIGNS[sign] = viseme

# Names of phones in ARPABET, and of Festival's voices of other languages where they differ from IPA.
ARPABET = {
    "p": [PP], "b": [PP], "m": [PP], "f": [FF], "v": [FF], "th": [TH], "dh": [TH], "t": [DD], "d": [DD], "dx": [DD],
    "k": [KK], "g": [KK], "ng": [KK], "sh": [CH], "zh": [CH], "ch": [CH], "jh": [CH], "s": [SS], "z": [SS],
    "n": [NN], "l": [NN], "r": [RR], "er": [RR], "axr": [RR], "aa": [AA], "ae": [AA], "ah": [AA], "ao": [OH],
    "aw": [AA, OU], "ay": [AA, IH], "ax": [E], "eh": [E], "ey": [E, IH], "ih": [IH], "ix": [IH], "iy": [IH],
    "y": [IH], "ow": [OH, OU], "oy": [OH, IH], "uh": [OU], "uw": [OU], "w": [OU],
}
ITALIAN = {"tS": [CH], "dZ": [CH], "S": [CH], "ts": [SS], "dz": [SS], "J": [NN], "L": [NN], "r": [RR], "O": [OH],
           "E": [E], "g": [KK], "j": [IH], "w": [OU], "ng": [KK], "nf": [NN]}
CZECH = {"c": [SS], "c~": [CH], "s~": [CH], "z~": [CH], "r~": [CH], "n~": [NN], "t~": [DD], "d~": [DD], "ch": [KK],
         "j": [IH], "dz": [SS], "dz~": [CH], "y": [IH], "x": [KK]}
CATALAN = {"ax": [E], "E": [E], "O": [OH], "S": [CH], "Z": [CH], "tS": [CH], "dZ": [CH], "J": [NN], "L": [NN],
           "rr": [RR], "r": [DD], "ts": [SS], "dz": [SS], "B": [PP], "D": [TH], "G": [KK], "j": [IH], "w": [OU],
           "uw": [OU], "y": [IH], "x": [CH], "ll": [NN], "ny": [NN]}
FINNISH = {"@": [AA], "a": [AA], "ae": [AA], "{": [AA], "oe": [OH], "2": [OH], "y": [OU], "N": [KK], "j": [IH],
           "nk": [KK], "rr": [RR], "r": [RR], "v": [FF]}
RUSSIAN = {"sch": [CH], "ch": [CH], "sh": [CH], "zh": [CH], "c": [SS], "ts": [SS], "kh": [KK], "h": [KK],
           "hh": [KK], "j": [IH], "y": [IH], "yy": [IH], "ae": [E], "e": [E], "ee": [E], "i": [IH], "ii": [IH],
           "o": [OH], "oo": [OH], "u": [OU], "uu": [OU], "a": [AA], "aa": [AA], "ay": [IH], "ur": [OU],
           "er": [E], "ar": [AA], "ir": [IH], "jj": [IH]}
SILENT = {"", "#", "_", "pau", "sil", "h#", "ssil", "##"}


def visemes_of_ipa(symbol):
    """The visemes of a sound that is written in IPA; None where the signs are not known."""
    marks = "ːˑˈˌ'.,:|‿˞0123456789-~^"
    signs = [s for s in unicodedata.normalize("NFD", symbol)
             if s not in marks and not unicodedata.combining(s) and unicodedata.category(s) != "Lm"]
    if not signs or any(s not in SIGNS for s in signs):
        return None
    found = [SIGNS[s] for s in signs]
    if all(v >= AA for v in found):
        return [found[0]] if found[0] == found[-1] else [found[0], found[-1]]
    return [found[-1]]


def visemes_of(symbol, table):
    """The visemes of a phone of a voice of Festival or flite."""
    if symbol in SILENT:
        return [SIL]
    for name in (symbol, symbol.rstrip("0123456789:'"), symbol.rstrip("0123456789:'*").replace(":", "")):
        if name in table:
            return table[name]
    short = symbol.rstrip("0123456789:'")
    if len(short) == 2 and short[0] == short[1]:  # Palatal consonants of Russian, long ones of others.
        short = short[0]
    return table.get(short) or visemes_of_ipa(short)


def write(path, rate, samples, sounds):
    """Writes the sound and its labels. `sounds` are (begin, end, visemes or None)."""
    with wave.open(path + ".wav", "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(rate)
        out.writeframes(samples.tobytes())
    with open(path + ".vis", "w") as out:
        for begin, end, visemes in sounds:
            if end <= begin:
                continue
            if visemes is not None and visemes == [SIL]:
                # A pause that is not quiet is the end or the beginning of a sound.
                part = samples[int(begin * rate):int(end * rate)]
                level = (sum(x * x for x in part) / max(1, len(part))) ** 0.5
                visemes = [SIL] if level < 130 else None
            names = [-1] if visemes is None else visemes
            step = (end - begin) / len(names)
            for i, viseme in enumerate(names):
                out.write(f"{begin + i * step:.4f} {begin + (i + 1) * step:.4f} {viseme}\n")


class Espeak:
    """libespeak-ng, which tells at which sample each phone begins."""

    class Event(ctypes.Structure):
        _fields_ = [("type", ctypes.c_int), ("uid", ctypes.c_uint), ("position", ctypes.c_int),
                    ("length", ctypes.c_int), ("audio", ctypes.c_int), ("sample", ctypes.c_int),
                    ("user", ctypes.c_void_p), ("name", ctypes.c_char * 8)]

    def __init__(self):
        self.library = ctypes.CDLL("libespeak-ng.so.1")
        self.rate = self.library.espeak_Initialize(2, 200, None, 1 | 2)
        kind = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int,
                                ctypes.POINTER(self.Event))
        self.callback = kind(self.take)
        self.library.espeak_SetSynthCallback(self.callback)

    def take(self, samples, count, events):
        if samples and count > 0:
            self.samples += ctypes.string_at(samples, 2 * count)
        i = 0
        while events[i].type != 0:
            if events[i].type == 7:
                self.phones.append((events[i].sample, events[i].name.decode("utf8", "replace")))
            i += 1
        return 0

    def say(self, path, voice, speed, text):
        self.samples, self.phones = b"", []
        if self.library.espeak_SetVoiceByName(voice.encode()) != 0:
            sys.exit(f"espeak-ng has no voice {voice}")
        self.library.espeak_SetParameter(1, speed, 0)
        data = text.encode()
        self.library.espeak_Synth(data, len(data) + 1, 0, 1, 0, 1, None, None)
        self.library.espeak_Synchronize()
        samples = array.array("h", self.samples)
        phones = [p for p in self.phones if not p[1].startswith("(")]
        ends = [p[0] for p in phones[1:]] + [len(samples)]
        sounds = []
        for (begin, name), end in zip(phones, ends):
            visemes = [SIL] if name == "" else visemes_of_ipa(name)
            sounds.append((begin / self.rate, end / self.rate, visemes))
        write(path, self.rate, samples, sounds)


def read_wave(path):
    with wave.open(path, "rb") as file:
        assert file.getnchannels() == 1 and file.getsampwidth() == 2
        return file.getframerate(), array.array("h", file.readframes(file.getnframes()))


def festival(folder, voice, table, encoding, lines, language):
    """Lets a voice of Festival say lines, each at a speed of its own."""
    script = f"(voice_{voice})\n"
    names = []
    for i, line in enumerate(lines):
        name = f"{folder}/festival-{language}-{voice}-{i:03}"
        names.append(name)
        text = line.replace('"', "")
        script += (f"(Parameter.set 'Duration_Stretch {[1.0, 0.8, 1.2, 0.9][i % 4]})\n"
                   f'(set! utt (utt.synth (eval (list \'Utterance \'Text "{text}"))))\n'
                   f"(utt.save.wave utt \"{name}.wav\" 'riff)\n(utt.save.segs utt \"{name}.lab\")\n")
    with open(f"{folder}/script.scm", "wb") as file:
        file.write(script.encode(encoding, "replace"))
    subprocess.run(["festival", "-b", f"{folder}/script.scm"], stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL, timeout=600)
    os.remove(f"{folder}/script.scm")
    unknown = set()
    for name in names:
        if not os.path.exists(name + ".lab"):
            continue
        rate, samples = read_wave(name + ".wav")
        begin, sounds = 0.0, []
        for row in open(name + ".lab", encoding="latin-1"):
            part = row.split()
            if len(part) != 3:
                continue
            visemes = visemes_of(part[2], table)
            if visemes is None:
                unknown.add(part[2])
            sounds.append((begin, float(part[0]), visemes))
            begin = float(part[0])
        os.remove(name + ".lab")
        write(name, rate, samples, sounds)
    print(voice, "unknown:", sorted(unknown), flush=True)


def flite(folder, voice, lines):
    for i, line in enumerate(lines):
        name = f"{folder}/flite-en-{voice}-{i:03}"
        stretch = [1.0, 0.8, 1.2][i % 3]
        done = subprocess.run(["flite", "-voice", voice, "--setf", f"duration_stretch={stretch}", "-psdur", "-t",
                               line, "-o", name + ".wav"], capture_output=True, text=True, check=True)
        rate, samples = read_wave(name + ".wav")
        begin, sounds = 0.0, []
        for word in done.stdout.split():
            symbol, end = word.rsplit(":", 1)
            sounds.append((begin, float(end), visemes_of(symbol, ARPABET)))
            begin = float(end)
        write(name, rate, samples, sounds)


def sox(*arguments):
    """Samples of 16 kHz that sox makes, by the arguments behind its input."""
    done = subprocess.run(["sox", "-R", "-n", "-r", "16000", "-c", "1", "-b", "16", "-e", "signed", "-t", "raw", "-",
                           *arguments], capture_output=True, check=True)
    return array.array("h", done.stdout)


def others(folder):
    """What is heard beside clean speech: noise over the test, silence, and music without a voice."""
    os.makedirs(f"{folder}/noise", exist_ok=True)
    pink = sox("synth", "60", "pinknoise")
    power = sum(x * x for x in pink) / len(pink)
    for name in sorted(os.listdir(f"{folder}/test")):
        if not name.endswith(".wav"):
            continue
        stem = name[:-4]
        rate, samples = read_wave(f"{folder}/test/{name}")
        # The voice's power is that of the frames within 30 dB of the loudest.
        frames = [samples[i:i + rate // 100] for i in range(0, len(samples), rate // 100)]
        powers = [sum(x * x for x in frame) / len(frame) for frame in frames]
        loud = [p for p in powers if p > 1e-3 * max(powers)]
        scale = (sum(loud) / len(loud) / 10 / power) ** 0.5
        mixed = array.array("h", (max(-32768, min(32767, int(x + scale * pink[i % len(pink)])))
                                  for i, x in enumerate(samples)))
        labels = [line.split() for line in open(f"{folder}/test/{stem}.vis")]
        write(f"{folder}/noise/{stem}", rate, mixed, [])
        with open(f"{folder}/noise/{stem}.vis", "w") as out:
            out.writelines(" ".join(label) + "\n" for label in labels)
    quiet = [("silence", "digital", array.array("h", [0] * 320000)),
             ("silence", "quiet-room", array.array("h", (x // 800 for x in pink[:320000]))),
             ("music", "plucked", sox("synth", "20", "pl", "A2", "pl", "E3", "pl", "A3", "pl", "C4", "repeat", "0")),
             ("music", "organ", sox("synth", "20", "sine", "220", "sine", "277", "sine", "330", "sine", "440",
                                    "tremolo", "2", "40", "gain", "-12")),
             ("music", "strings", sox("synth", "20", "sawtooth", "196", "sawtooth", "247", "sawtooth", "294",
                                      "lowpass", "2500", "tremolo", "5", "30", "gain", "-14")),
             ("music", "drums", sox("synth", "20", "whitenoise", "fade", "0", "0.3", "0.28", "repeat", "40", "trim", "0",
                                    "20", "gain", "-10"))]
    for place, name, samples in quiet:
        os.makedirs(f"{folder}/{place}", exist_ok=True)
        write(f"{folder}/{place}/{name}", 16000, samples, [])
        with open(f"{folder}/{place}/{name}.vis", "w") as out:
            out.write(f"0 {len(samples) / 16000} 0\n")


def shuffled(lines, count, rng):
    """The lines, then others of the same words in another order."""
    words = [w for line in lines for w in re.sub(r"[.,?!¿]", "", line).split()]
    made = list(lines)
    while len(made) < count:
        made.append(" ".join(rng.sample(words, min(len(words), rng.randint(6, 11)))) + ".")
    return made[:count]


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    texts, name = {}, None
    for line in open(f"{here}/texts.txt", encoding="utf8"):
        line = line.strip()
        if line.startswith("["):
            name = line[1:-1]
            texts[name] = []
        elif line and not line.startswith("#"):
            texts[name].append(line)
    rng = random.Random(1)
    train, test = f"{sys.argv[1]}/train", f"{sys.argv[1]}/test"
    os.makedirs(train, exist_ok=True)
    os.makedirs(test, exist_ok=True)

    for voice in ["awb", "rms", "slt"]:
        flite(test, voice, texts["test en"])
    festival(test, "cmu_us_slt_arctic_hts", ARPABET, "utf8", texts["test en"], "en")
    festival(test, "pc_diphone", ITALIAN, "latin-1", texts["test it"], "it")
    festival(test, "czech_machac", CZECH, "iso8859-2", texts["test cs"], "cs")
    festival(test, "msu_ru_nsh_clunits", RUSSIAN, "utf8", texts["test ru"], "ru")

    others(sys.argv[1])

    for voice, table, encoding, language, count in [
        ("ked_diphone", ARPABET, "utf8", "en", 140), ("kal_diphone", ARPABET, "utf8", "en", 140), ("lp_diphone", ITALIAN, "latin-1", "it", 90),
        ("czech_dita", CZECH, "iso8859-2", "cs", 40), ("czech_krb", CZECH, "iso8859-2", "cs", 30),
        ("czech_ph", CZECH, "iso8859-2", "cs", 40), ("upc_ca_ona_hts", CATALAN, "latin-1", "ca", 110),
        ("hy_fi_mv_diphone", FINNISH, "latin-1", "fi", 40), ("suo_fi_lj_diphone", FINNISH, "latin-1", "fi", 40),
    ]:
        festival(train, voice, table, encoding, shuffled(texts[language], count, rng), language)

    espeak = Espeak()
    variants = ["", "+f1", "+f2", "+f3", "+f4", "+m1", "+m2", "+m3", "+m4", "+m7", "+klatt", "+klatt2", "+klatt3",
                "+klatt4", "+Michael", "+linda", "+Andrea", "+adam", "+steph", "+max"]
    languages = {"en": ["gmw/en-US", "gmw/en", "gmw/en-GB-x-rp", "gmw/en-GB-scotland"], "pt": ["pt"], "fr": ["fr"]}
    for language in [name for name in texts if " " not in name]:
        voices = languages.get(language, [language])
        for i, variant in enumerate(variants):
            count = 12 if language == "en" else 3
            for j, line in enumerate(shuffled(rng.sample(texts[language], len(texts[language])), 60, rng)[-count:]
                                     if i % 3 else rng.sample(texts[language], min(count, len(texts[language])))):
                voice = voices[(i + j) % len(voices)] + variant
                espeak.say(f"{train}/espeak-{language}-{i:02}-{j:02}", voice, rng.choice([130, 155, 180, 220]), line)


if __name__ == "__main__":
    main()
