// Lets wlipsync and @met4citizen/headaudio hear what `hearing-trainer --table` measures.
//
//   npm install --prefix OTHERS wlipsync @met4citizen/headaudio
//   node compare.mjs OTHERS/node_modules DATA
//
// Writes NAME.headaudio and NAME.wlipsync beside each sound of DATA (what speak.py made): a time in seconds
// and the number of the viseme heard from then on, a line each. Both run outside of a browser, on samples of
// 16 kHz.
//
// HeadAudio has its own model (dist/model-en-mixed.bin), and its visemes are taken from its processor, before
// its node loses "aa" (its number there is 0). wlipsync ships no profile: it is calibrated as its author
// describes, on the very voices that our model is trained on, with twelve visemes (it has room for no more;
// TH and RR are left out), and its default volume below which nobody speaks.
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [modules, data] = process.argv.slice(2);
const headaudio = path.join(modules, "@met4citizen/headaudio");
const load = (file) => import(pathToFileURL(path.join(headaudio, "modules", file)));
const { Processor } = await load("processor.mjs");
const { Training } = await load("training.mjs");
const OURS = ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U"];
const THEIRS = ["aa", "E", "I", "O", "U", "PP", "SS", "TH", "DD", "FF", "kk", "nn", "RR", "CH", "sil"];

// Zeros of the resampling kernel on each side.
const ZEROS = 8;

/** The samples of a file at 16 kHz. */
function wave(file) {
    const bytes = fs.readFileSync(file);
    const rate = bytes.readUInt32LE(24);
    const count = (bytes.length - 44) >> 1;
    const samples = new Float32Array(count);
    for (let i = 0; i < count; i++) samples[i] = bytes.readInt16LE(44 + 2 * i) / 32768;
    if (rate === 16000) return samples;
    // The kernel of avatar-hearing's own resampler, so that all three hear the same sound.
    const cut = 0.92 * Math.min(1, 16000 / rate), half = Math.ceil(ZEROS / cut);
    const out = new Float32Array(Math.floor((count * 16000) / rate));
    for (let i = 0; i < out.length; i++) {
        const at = (i * rate) / 16000;
        const from = Math.max(0, Math.floor(at) - half), to = Math.min(count - 1, Math.floor(at) + half + 1);
        for (let j = from; j <= to; j++) {
            const zeros = Math.abs(j - at) * cut;
            const sinc = zeros === 0 ? 1 : Math.sin(Math.PI * zeros) / (Math.PI * zeros);
            out[i] += samples[j] * cut * sinc * (0.5 + 0.5 * Math.cos(Math.PI * Math.min(1, zeros / ZEROS)));
        }
    }
    return out;
}

const stems = (folder) => fs.readdirSync(path.join(data, folder)).filter((name) => name.endsWith(".wav"))
    .map((name) => path.join(data, folder, name.slice(0, -4)));

// HeadAudio.
const fetched = globalThis.fetch;
globalThis.fetch = async (file) => new Response(fs.readFileSync(file));
const { model } = await new Training().loadModel(path.join(headaudio, "dist/model-en-mixed.bin"));
globalThis.fetch = fetched;

function hearHeadAudio(samples) {
    const events = [[0, 0]];
    const processor = new Processor({ sampleRate: 16000 }, {
        port: {
            postMessage: (message) => {
                if (message.event === "viseme" && message.viseme !== null) {
                    events.push([message.t, OURS.indexOf(THEIRS[message.viseme])]);
                } else if (message.event === "ended") {
                    events.push([message.t - 0.016, 0]);
                }
            },
        },
    });
    processor._onmessage({ data: { event: "model", model, reset: true } });
    for (let i = 0; i < samples.length; i += 128) processor.process(samples.subarray(i, i + 128));
    return events;
}

// wlipsync.
const memory = new WebAssembly.Memory({ initial: 4 });
const wasm = fs.readFileSync(path.join(modules, "wlipsync/dist/wlipsync.wasm"));
const { exports: lips } = (await WebAssembly.instantiate(wasm, { env: { memory } })).instance;
const NAMED = [1, 2, 4, 5, 6, 7, 8, 10, 11, 12, 13, 14];
const EXAMPLES = 12;
// Rate, samples of a window, bands, comparison (1 is the square of the distance), names, examples,
// standardised: the defaults of the project that wlipsync is a port of.
const raw = lips.load_profile(16000, 1024, 30, 1, NAMED.length, EXAMPLES, 1);
lips.set_input(16000);

function* windows(samples) {
    const size = lips.get_input_buffer_size();
    const buffer = new Float32Array(memory.buffer, lips.get_input_buffer(), size);
    buffer.fill(0);
    let place = 0;
    for (let i = 0; i + 128 <= samples.length; i += 128) {
        for (let j = 0; j < 128; j++) {
            buffer[place] = samples[i + j];
            place = (place + 1) % size;
        }
        const index = lips.execute(place);
        // The middle of the window.
        yield [(i + 128 - 512) / 16000, index];
    }
}

{
    const sums = NAMED.map(() => Array.from({ length: EXAMPLES }, () => ({ sum: new Float64Array(12), count: 0 })));
    for (const [number, stem] of stems("train").entries()) {
        if (number % 3 !== 0) continue;
        const labels = fs.readFileSync(stem + ".vis", "utf8").trim().split("\n").map((l) => l.split(" ").map(Number));
        let at = 0;
        for (const [time] of windows(wave(stem + ".wav"))) {
            while (at + 1 < labels.length && labels[at][1] <= time) at++;
            const name = NAMED.indexOf(labels[at][2]);
            // The middles of sounds, as in somebody's calibration.
            const [begin, end] = labels[at];
            if (name < 0 || time < begin + 0.25 * (end - begin) || time > end - 0.25 * (end - begin)) continue;
            const mfcc = new Float32Array(memory.buffer, lips.mfccOut.value, 12);
            if (!mfcc.every(Number.isFinite)) continue;
            const example = sums[name][(number / 3) % EXAMPLES];
            for (let i = 0; i < 12; i++) example.sum[i] += mfcc[i];
            example.count++;
        }
    }
    const profile = new Float32Array(memory.buffer, raw, NAMED.length * EXAMPLES * 12);
    sums.flat().forEach((example, index) => {
        for (let i = 0; i < 12; i++) profile[12 * index + i] = example.sum[i] / Math.max(1, example.count);
    });
    lips.precompute_profile();
}

function hearWlipsync(samples) {
    const events = [[0, 0]];
    for (const [time, index] of windows(samples)) {
        const volume = new Float32Array(memory.buffer, lips.get_volume_ptr(), 1)[0];
        events.push([Math.max(0, time), Math.log10(volume) <= -2.5 ? 0 : NAMED[index] ?? 0]);
    }
    return events;
}

for (const folder of ["test", "noise", "silence", "music"]) {
    for (const stem of stems(folder)) {
        const samples = wave(stem + ".wav");
        for (const [name, hear] of [["headaudio", hearHeadAudio], ["wlipsync", hearWlipsync]]) {
            const lines = hear(samples).map(([time, viseme]) => `${time.toFixed(4)} ${viseme}`);
            fs.writeFileSync(`${stem}.${name}`, lines.join("\n") + "\n");
        }
    }
    console.log(folder);
}
