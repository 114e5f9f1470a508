// A face on a canvas. See README.md and mimik.d.ts for what it can do.
import init, { Device, Face } from "./avatar_web.js";

const BUILT_IN = { marsienne: "marsienne.zip" };
/** Milliseconds between looks whether the device is still there, and before it is opened again. */
const LOOK_MS = 300;
const AGAIN_MS = [0, 500, 2000, 5000];

/** What drawing returns where nobody would see a difference. */
const UNSEEN = -2;

let library; // a promise of the library and its memory
let memory;

function near(file) {
  return new URL(file, import.meta.url);
}

/** Fetches a file, and tells the share of its bytes that has arrived. */
async function fetched(url, progress) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: expected a file, found ${response.status} ${response.statusText}`);
  const total = Number(response.headers.get("content-length"));
  // Where a server packs what it sends, the length says nothing of what is unpacked.
  const isPacked = response.headers.get("content-encoding");
  let length = 0;
  const counted = new TransformStream({
    transform(piece, controller) {
      length += piece.length;
      progress(total && !isPacked ? Math.min(length / total, 1) : length / (length + 2e6));
      controller.enqueue(piece);
    },
    flush: () => progress(1),
  });
  return new Response(response.body.pipeThrough(counted), { headers: { "content-type": response.headers.get("content-type") ?? "" } });
}

function load(progress) {
  library ??= (async () => {
    // It is compiled while it arrives, where the server says what it is.
    ({ memory } = await init({ module_or_path: await fetched(near("avatar_web_bg.wasm"), progress) }));
  })();
  // After a failure one may try again.
  library.catch(() => (library = undefined));
  return library;
}

/** Why nothing can be drawn here, for people; null where it can. */
export function whyNot() {
  if (!globalThis.isSecureContext) {
    return "This page is not loaded over https (or from this computer), and browsers offer WebGPU only where it is.";
  }
  if (!navigator.gpu) {
    return (
      "This browser has no WebGPU. Chrome and Edge have it from version 113 on, Safari from 26, Firefox from 141 " +
      "on Windows and 145 on a Mac; on Linux it may have to be switched on."
    );
  }
  return null;
}

/** Options of the look as scripts write them: hairColor for hair-color. */
const option = (name) => name.replace(/[A-Z]/g, (letter) => "-" + letter.toLowerCase());

/** Sounds and their times as a table that the library reads. */
function table(visemes) {
  return visemes.map(({ time, viseme, strength = 1 }) => `${time}\t${viseme}\t${strength}`).join("\n") + "\n";
}

function mono(buffer) {
  const sum = new Float32Array(buffer.length);
  for (let channel = 0; channel < buffer.numberOfChannels; channel++) {
    const samples = buffer.getChannelData(channel);
    for (let i = 0; i < sum.length; i++) sum[i] += samples[i] / buffer.numberOfChannels;
  }
  return sum;
}

export class Mimik extends EventTarget {
  #face;
  #canvas;
  #frame = 0; // the frame that is asked for
  #before; // when the last one was
  #inFlight = 0;
  #frames = 0;
  #open = false; // whether there is a device to draw with
  #loads = 0; // avatars that were asked for
  #hasFailed = false; // whether the latest frame failed
  #arriving = false;
  #speaking = false;
  #sound; // what is played while she speaks
  #microphone;
  #watch;
  #sizes;
  #channels;
  #times = { fetch: 0, read: 0, show: 0 };

  /** Shows a face on a canvas. */
  static async create(canvas, { avatar = "marsienne", quality, look = {}, link, onprogress = () => {} } = {}) {
    const why = whyNot();
    if (why) throw new Error(why);
    const started = performance.now();
    // The first one that is asked for takes the browser longest: it may while the library is on its way.
    navigator.gpu.requestAdapter().catch(() => {});
    // The library is about as large as the face.
    const shares = [0, 0];
    const part = (index) => (share) => {
      shares[index] = share;
      onprogress((shares[0] + shares[1]) / 2);
    };
    // A library that is there already, or on its way for another face, tells nothing here.
    const library = load(part(0)).then(() => part(0)(1));
    const arriving = Promise.all([Mimik.#bytes(avatar, part(1)), library]).then(([file]) => ({ ...file, arrived: performance.now() }));
    // Whoever waits for it later is told.
    arriving.catch(() => {});
    await library;
    const words = Object.entries({ ...(quality && { quality }), ...look }).map(([key, word]) => [option(key), String(word)]);
    const mimik = new Mimik();
    mimik.#canvas = canvas;
    const { clientWidth, clientHeight } = canvas;
    mimik.#fit();
    // A canvas that no style sizes is as large as its pixels, and would grow with each fit.
    if (canvas.clientWidth !== clientWidth || canvas.clientHeight !== clientHeight) {
      Object.assign(canvas.style, { width: `${clientWidth}px`, height: `${clientHeight}px` });
    }
    // While the face arrives and is read, the device is opened and compiles what will draw it.
    const hasHair = BUILT_IN[avatar] !== undefined;
    const all = [link ?? "", ...words.map(([key, word]) => `${key}=${encodeURIComponent(word)}`)].join("&");
    const opening = Device.open(canvas, all, hasHair);
    opening.catch(() => {});
    let device;
    let arrived;
    try {
      // First the device: what it compiles, it compiles while the face is read.
      let name, bytes;
      [device, { name, bytes, arrived }] = await Promise.all([opening, arriving]);
      mimik.#face = new Face(name, bytes);
    } catch (error) {
      // A device for which there is no face.
      opening.then((device) => device.free(), () => {});
      throw error;
    }
    try {
      if (link) mimik.#face.follow(link);
      for (const [key, word] of words) mimik.#face.look(key, word);
      const read = performance.now();
      await mimik.#show(device);
      // At once, and until it is there: frames are not asked for in tabs that nobody sees.
      mimik.#face.advance(0);
      mimik.#draw(0);
      await mimik.#face.done();
      mimik.#times = { fetch: arrived - started, read: read - arrived, show: performance.now() - read };
    } catch (error) {
      mimik.close();
      throw error;
    }
    mimik.#sizes = new ResizeObserver(() => mimik.#fit() && mimik.#resized());
    mimik.#sizes.observe(canvas);
    mimik.#watch = setInterval(() => mimik.#check(), LOOK_MS);
    // After whoever waits for this has had the time to listen.
    setTimeout(() => mimik.#face && mimik.#tell("loaded", mimik.info()));
    return mimik;
  }

  static async #bytes(avatar, progress) {
    if (typeof avatar === "string" || avatar instanceof URL) {
      const url = BUILT_IN[avatar] ? near(BUILT_IN[avatar]) : new URL(avatar, document.baseURI);
      const name = decodeURIComponent(url.pathname.split("/").pop());
      return { name, bytes: new Uint8Array(await (await fetched(url, progress)).arrayBuffer()) };
    }
    progress(1);
    if (avatar instanceof Blob) return { name: avatar.name ?? "", bytes: new Uint8Array(await avatar.arrayBuffer()) };
    return { name: avatar.name ?? "", bytes: new Uint8Array(avatar.bytes ?? avatar) };
  }

  // What moves the face.

  /** Heads for a pose, or for a mixture such as "smile:0.5 wink-left". */
  press(pose) {
    this.#call(() => this.#face.press(pose));
  }

  /** Takes controls to values: { jawOpen: 0.4 }. */
  set(values) {
    this.#call(() => {
      for (const [control, value] of Object.entries(values)) this.#face.set(control, value);
    });
  }

  /** Plays a clip of the avatar. */
  play(clip) {
    this.#call(() => this.#face.play(clip));
  }

  /** Comes to rest and says no more. */
  stop() {
    this.hush();
    this.#call(() => this.#face.stop());
  }

  /** Speaks: an AudioBuffer, which is played as well unless `silent`; a list of visemes; or the text of a file. */
  speak(what, { silent = false, context, from = 0 } = {}) {
    this.hush();
    this.#call(() => {
      if (typeof what === "string") this.#face.speak(what, from - 0.2);
      else if (Array.isArray(what)) this.#face.speak(table(what), from - 0.2);
      else {
        this.#face.speak_sound(mono(what), what.sampleRate, from);
        if (!silent) this.#play(what, context, from);
      }
      this.#speaking = true;
    });
  }

  #play(buffer, given, from) {
    const context = given ?? new AudioContext();
    const source = new AudioBufferSourceNode(context, { buffer });
    source.connect(context.destination);
    // Without a click or key before, a browser keeps silent; the mouth then goes by its own time.
    const started = context.currentTime;
    source.start(started, from);
    const own = { secs: () => context.currentTime - started + from - (context.outputLatency || 0) };
    own.runs = () => context.state === "running" && context.currentTime > started;
    own.end = () => {
      source.onended = null;
      source.stop();
      if (!given) context.close();
    };
    this.#sound = own;
    source.onended = () => {
      own.end();
      if (this.#sound === own) this.#sound = undefined;
    };
  }

  /** Speaks by what comes from a microphone, until hush() is called. */
  async listen(stream) {
    this.hush();
    const context = new AudioContext();
    // Whoever hushes from here on ends it.
    const own = (this.#microphone = { context, stream });
    const code = `registerProcessor("ear", class extends AudioWorkletProcessor {
      process([[samples]]) { if (samples) this.port.postMessage(samples.slice()); return true; }
    })`;
    const url = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
    try {
      await context.audioWorklet.addModule(url);
    } catch (error) {
      if (this.#microphone !== own) return;
      this.hush();
      throw error;
    } finally {
      URL.revokeObjectURL(url);
    }
    if (this.#microphone !== own) return;
    const ear = new AudioWorkletNode(context, "ear", { numberOfOutputs: 0 });
    ear.port.onmessage = ({ data }) => {
      if (this.#microphone !== own) return;
      try {
        this.#call(() => this.#face.listen(data, context.sampleRate));
      } catch (error) {
        this.hush();
        this.#tell("error", error);
      }
    };
    context.createMediaStreamSource(stream).connect(ear);
  }

  /** Says no more. */
  hush() {
    this.#sound?.end();
    this.#sound = undefined;
    this.#microphone?.stream.getTracks().forEach((track) => track.stop());
    this.#microphone?.context.close();
    this.#microphone = undefined;
    this.#call(() => this.#face.hush());
  }

  /** Blinks, glances and breath: "calm", "lively", "tired", "nervous", "listening" or "off". */
  life(style, seed = 0) {
    this.#call(() => this.#face.live(style, seed));
  }

  /** Looks at a point in the avatar's space, or ahead without one. */
  lookAt(x = NaN, y = NaN, z = NaN) {
    this.#call(() => this.#face.look_at(x, y, z));
  }

  /** Looks toward a place of the page, in CSS pixels of the window. */
  lookToward(clientX, clientY) {
    const box = this.#canvas.getBoundingClientRect();
    const right = ((clientX - box.left) / box.width) * 2 - 1;
    const up = 1 - ((clientY - box.top) / box.height) * 2;
    this.#call(() => this.#face.look_toward(right, up, box.width / box.height));
  }

  /** Goes where a tracker says: weights of ARKit's shapes, angles of the head in degrees. */
  drive(weights) {
    this.#call(() => {
      this.#channels ??= new Map(Face.channels().map((name, index) => [name, index]));
      const values = new Float32Array(this.#channels.size).fill(NaN);
      for (const [name, value] of Object.entries(weights)) {
        // MediaPipe's own first shape says nothing.
        if (name === "_neutral") continue;
        const index = this.#channels.get(name);
        if (index === undefined) throw new Error(`expected the name of a channel, found "${name}"`);
        values[index] = value;
      }
      this.#face.drive(values);
    });
  }

  // How it looks.

  /** Sets options: { light: "dramatic", hair: "bob", hairColor: "red", skin: "brown", iris: "green" }. */
  look(options) {
    this.#call(() => {
      for (const [key, word] of Object.entries(options)) this.#face.look(option(key), String(word));
    });
  }

  /** Makes somebody else of the avatar: "seed:7", or { jaw: 0.5 }; "" is the avatar itself. */
  identity(who) {
    const text = typeof who === "string" ? who : Object.entries(who).map(([axis, value]) => `${axis}=${value}`).join(" ");
    this.#call(() => this.#face.become_person(text));
  }

  /** Turns the camera by degrees to the face's left and up; goes nearer where zoom is below 1. */
  orbit(yaw, pitch = 0, zoom = 1) {
    this.#call(() => this.#face.orbit(yaw, pitch, zoom));
  }

  /** Back to the front. */
  front() {
    this.#call(() => this.#face.front());
  }

  /** Puts another avatar in the place of this one. */
  async load(avatar, { onprogress = () => {} } = {}) {
    const own = (this.#loads += 1);
    const { name, bytes } = await Mimik.#bytes(avatar, onprogress);
    // Closed meanwhile, or somebody has asked for another one.
    if (!this.#face || own !== this.#loads) return;
    this.hush();
    this.#call(() => this.#face.load(name, bytes));
    this.#tell("loaded", this.info());
  }

  // What comes out.

  /** Everything there is to press, set and choose. */
  info() {
    return { ...JSON.parse(this.#face.info()), frames: this.#frames, times: this.#times, bytes: memory.buffer.byteLength };
  }

  /** The face as the query of an address. */
  link() {
    return this.#face.link();
  }

  /** Goes where a link says; returns what of it does not exist here. */
  follow(link) {
    return this.#call(() => this.#face.follow(link));
  }

  /** The numbers behind the picture: of controls, bones (twelve each) and shapes. */
  state() {
    return { values: this.#face.values(), bones: this.#face.bones(), weights: this.#face.weights() };
  }

  /** The pixels of a picture of any size. */
  async pixels(width = this.#canvas.width, height = this.#canvas.height) {
    return this.#face.picture(width, height);
  }

  /** A picture of any size, as a PNG. */
  async picture(width, height) {
    const pixels = await this.pixels(width, height);
    const canvas = new OffscreenCanvas(pixels.width, pixels.height);
    canvas.getContext("2d").putImageData(pixels, 0, 0);
    return canvas.convertToBlob({ type: "image/png" });
  }

  /** Whether all controls have arrived; life and speech may go on. */
  get arrived() {
    return !this.#face.is_arriving();
  }

  /** Whether a microphone is on. */
  get listening() {
    return this.#microphone !== undefined;
  }

  /** Whether nothing moves and all that has changed is drawn. */
  get still() {
    return this.#open && !this.#frame && this.#inFlight === 0 && !this.#face.is_waiting();
  }

  /** Ends all of it; the canvas may be used again. */
  close() {
    this.hush();
    cancelAnimationFrame(this.#frame);
    clearInterval(this.#watch);
    this.#sizes?.disconnect();
    this.#open = false;
    // At once: else it is the browser that decides when.
    this.#face.lose();
    this.#face.free();
    this.#face = undefined;
  }

  /** Loses the device, as a driver that fails does: for tests. */
  lose() {
    this.#face.lose();
  }

  // How it goes on.

  #tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }

  /** Calls the library; then there may be something to draw. */
  #call(what) {
    const result = what();
    this.#arriving ||= this.#face.is_arriving();
    this.#ask();
    return result;
  }

  /** Fits the canvas to its place on the page, in pixels of the screen. Returns whether that changed anything. */
  #fit() {
    const ratio = globalThis.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = this.#canvas;
    const width = Math.max(1, Math.round(clientWidth * ratio));
    const height = Math.max(1, Math.round(clientHeight * ratio));
    if (this.#canvas.width === width && this.#canvas.height === height) return false;
    Object.assign(this.#canvas, { width, height });
    return true;
  }

  #resized() {
    try {
      this.#face.resize(this.#canvas.width, this.#canvas.height);
      // At once: a canvas whose size has changed is empty.
      if (this.#open) this.#draw(0);
    } catch (error) {
      if (!this.#face.is_lost()) this.#tell("error", error);
    }
  }

  /** Shows the face with a device. */
  async #show(opening = this.#face.open(this.#canvas)) {
    this.#open = false;
    const device = await opening;
    if (!this.#face) {
      // Closed meanwhile.
      device.free();
      return;
    }
    this.#face.begin(device);
    // The device takes what is uploaded while hair is planted.
    await new Promise((resolve) => {
      const { port1, port2 } = new MessageChannel();
      port1.onmessage = resolve;
      port2.postMessage(0);
    });
    if (!this.#face) return;
    this.#face.plant();
    this.#open = true;
    this.#inFlight = 0;
    this.#ask();
  }

  async #check() {
    if (!this.#open || !this.#face.is_lost()) return;
    this.#open = false;
    this.#tell("lost");
    for (const ms of AGAIN_MS) {
      await new Promise((resolve) => setTimeout(resolve, ms));
      if (!this.#face) return;
      try {
        await this.#show();
        if (!this.#face) return;
        this.#tell("restored");
        return;
      } catch (error) {
        if (ms === AGAIN_MS.at(-1)) this.#tell("error", error);
      }
    }
  }

  #ask() {
    if (!this.#frame && this.#open) this.#frame = requestAnimationFrame((now) => this.#next(now));
  }

  #next(now) {
    this.#frame = 0;
    if (!this.#open || this.#inFlight > this.#ahead) return; // who is done asks again
    const dt = this.#before === undefined ? 0 : (now - this.#before) / 1000;
    try {
      if (this.#sound?.runs()) this.#face.speak_at(this.#sound.secs());
      this.#face.advance(dt);
      if (this.#face.is_waiting()) {
        this.#before = now;
        this.#draw(dt);
      } else {
        this.#before = undefined;
      }
      this.#hasFailed = false;
    } catch (error) {
      this.#before = undefined;
      if (this.#face.is_lost()) return;
      this.#tell("error", error);
      // Once more: memory may have run out for a moment. After that, when something happens.
      if (!this.#hasFailed) this.#ask();
      this.#hasFailed = true;
      return;
    }
    if (this.#arriving && !this.#face.is_arriving()) {
      this.#arriving = false;
      this.#tell("arrived");
    }
    if (this.#speaking && !this.#face.is_speaking()) {
      this.#speaking = false;
      this.#tell("spoken");
    }
  }

  #draw(dt) {
    const level = this.#face.draw(dt, false);
    if (level === UNSEEN) {
      this.#ask();
      return;
    }
    this.#frames += 1;
    this.#inFlight += 1;
    const began = performance.now();
    this.#face.done().then(() => {
      this.#inFlight = Math.max(0, this.#inFlight - 1); // none of a device that is gone
      if (!this.#open) return;
      if (level >= 0) this.#face.note(level, (performance.now() - began) / 1000);
      this.#ask();
    });
    if (this.#inFlight < 1 + this.#ahead) this.#ask();
  }

  /** Frames that may be asked for before one is drawn: none where software draws. */
  get #ahead() {
    return this.#face.is_software() ? 0 : 1;
  }
}

export default Mimik;
