/** Where an avatar comes from: an address, a file, bytes (with a name, which tells the format by its end), or the built-in face. */
export type Avatar =
  | "marsienne"
  | string
  | URL
  | Blob
  | ArrayBuffer
  | Uint8Array
  | { name: string; bytes: ArrayBuffer | Uint8Array };

/** Names of weights and angles of a tracker: the 52 shapes of ARKit, `head.turn` and the like in degrees, expressions of VRM. */
export type Weights = Record<string, number>;

/** How the face looks; "auto" takes an option back. Colours are names of `info().options`, or "#rrggbb". */
export interface Look {
  quality?: "auto" | "plain" | "low" | "medium" | "high";
  style?: "auto" | "natural" | "toon";
  light?: "auto" | "studio" | "daylight" | "dramatic" | "flat";
  toneMap?: "auto" | "neutral" | "agx";
  /** Stops, from -10 to 10. */
  exposure?: number | "auto";
  hair?: "auto" | "off" | "short" | "bob" | "long" | "curly" | "mohawk" | "bald";
  hairColor?: string;
  /** How many strands, by the usual number. */
  hairDensity?: number | "auto";
  skin?: string;
  iris?: string;
  /** "#rrggbb"; "transparent" in pictures alone. */
  background?: string;
}

export interface Options {
  /** The face; "marsienne" without. */
  avatar?: Avatar;
  /** How much care is taken; without it that which the device draws smoothly. */
  quality?: Look["quality"];
  look?: Look;
  /** What `link()` returned once: the face begins there. */
  link?: string;
  /** Called with the share that is loaded, 0 to 1. */
  onprogress?: (share: number) => void;
}

/** A sound and its time: the names of Oculus Lipsync (sil, PP, FF, TH, DD, kk, CH, SS, nn, RR, aa, E, ih, oh, ou). */
export interface Viseme {
  /** Seconds from the beginning. */
  time: number;
  viseme: string;
  /** 0 to 1; 1 without. */
  strength?: number;
}

/** Something that `set` moves. */
export interface Control {
  name: string;
  /** Heading under which it is listed. */
  group: string;
  unit: "degrees" | "units" | "weight";
  min: number;
  max: number;
  default: number;
  /** Where it is heading. */
  value: number;
}

/** What there is to press, set and choose, and how things are. */
export interface Info {
  name: string;
  controls: Control[];
  poses: { name: string; key: string | null }[];
  clips: { name: string; seconds: number }[];
  identity: { now: string; axes: string[] };
  /** The words that each option of the look, and "life", knows. Keys have dashes: "hair-color". */
  options: Record<string, string[]>;
  /** The options that are set, with keys as above. */
  look: Record<string, string>;
  life: string;
  /** Whether it has anything to speak with. */
  speaks: boolean;
  /** Whose numbers `state()` tells, in that order. */
  names: { bones: string[]; shapes: string[] };
  parts: number;
  joints: number;
  shapes: number;
  vertices: number;
  triangles: number;
  /** Strands of hair, the device and the quality; missing while no device is open. */
  strands?: number;
  /** What was mended, left out or not understood while reading. */
  notes: string[];
  adapter?: string;
  quality?: string;
  /** Frames that were drawn so far. */
  frames: number;
  /** Milliseconds that loading took: fetching library and face; opening the device and reading the face; and the
   *  upload with the first picture. */
  times: { fetch: number; read: number; show: number };
  /** Bytes of the library's memory. */
  bytes: number;
}

/** Events of a face. */
export interface Events {
  /** An avatar is shown. */
  loaded: CustomEvent<Info>;
  /** All controls have come to where they were heading. */
  arrived: CustomEvent<null>;
  /** The face says no more: it has ended, or was hushed. */
  spoken: CustomEvent<null>;
  /** The device is lost; it is opened again by itself. */
  lost: CustomEvent<null>;
  /** The device is back, with the face as it was. */
  restored: CustomEvent<null>;
  /** Something failed that nobody waited for. */
  error: CustomEvent<Error>;
}

/** Why nothing can be drawn in this browser, in words for people; null where it can. */
export function whyNot(): string | null;

/** A face on a canvas. What it cannot do it throws, as an Error with the library's message. */
export class Mimik extends EventTarget {
  /** Loads the library and a face, and shows it on a canvas, whose place on the page says its size. */
  static create(canvas: HTMLCanvasElement, options?: Options): Promise<Mimik>;

  /** Heads for a pose, or for a mixture such as "smile:0.5 wink-left". */
  press(pose: string): void;
  /** Takes controls to values, in the time that a hand needs for a slider. */
  set(values: Record<string, number>): void;
  /** Plays a clip of the avatar. */
  play(clip: string): void;
  /** Comes to rest and says no more. */
  stop(): void;
  /**
   * Speaks: a sound, in any language, which is played as well; a list of visemes; or the text of a file of
   * Rhubarb, Praat, Polly, Azure and others.
   */
  speak(what: AudioBuffer | Viseme[] | string, how?: { silent?: boolean; context?: AudioContext; from?: number }): void;
  /** Speaks by what comes from a microphone, until `hush()`. */
  listen(stream: MediaStream): Promise<void>;
  /** Says no more. */
  hush(): void;
  /** Blinks, glances and breath; the same seed gives the same life. */
  life(style: "calm" | "lively" | "tired" | "nervous" | "listening" | "off", seed?: number): void;
  /** Looks at a point in the avatar's space (+y up, the face looks along +z), or ahead without one. */
  lookAt(x?: number, y?: number, z?: number): void;
  /** Looks toward a place in the window, in CSS pixels. */
  lookToward(clientX: number, clientY: number): void;
  /** Goes where a tracker says, at once. */
  drive(weights: Weights): void;

  /** Sets how it looks. */
  look(options: Look): void;
  /** Makes somebody else of the avatar: "seed:7", or values of `info().identity.axes` from -1 to 1; "" is the avatar itself. */
  identity(who: string | Record<string, number>): void;
  /** Turns the camera by degrees to the face's left and up; goes nearer where zoom is below 1. */
  orbit(yaw: number, pitch?: number, zoom?: number): void;
  /** The camera as it was at first. */
  front(): void;
  /**
   * Puts another avatar in the place of this one, at rest and from the front; the look stays. If it cannot be
   * read, this one stays, and says no more.
   */
  load(avatar: Avatar, how?: { onprogress?: (share: number) => void }): Promise<void>;

  /** Everything there is to press, set and choose. */
  info(): Info;
  /** The face as the query of an address, to all digits. */
  link(): string;
  /** Goes where a link says, at once; returns what of it does not exist here. */
  follow(link: string): string[];
  /** The numbers behind the picture: of controls, bones (twelve each: three columns and the translation) and shapes. */
  state(): { values: Float32Array; bones: Float32Array; weights: Float32Array };
  /** A picture of any size, whatever the canvas shows: PNG. */
  picture(width?: number, height?: number): Promise<Blob>;
  /** The same as pixels. */
  pixels(width?: number, height?: number): Promise<ImageData>;
  /** Whether all controls have arrived; life and speech may go on. */
  readonly arrived: boolean;
  /** Whether a microphone is on. */
  readonly listening: boolean;
  /** Whether nothing moves and all that has changed is drawn: never while it lives. */
  readonly still: boolean;
  /** Ends all of it and gives its memory back. */
  close(): void;
  /** Loses the device, as a driver that fails does: for tests. */
  lose(): void;

  addEventListener<K extends keyof Events>(type: K, listener: (event: Events[K]) => void, options?: boolean | AddEventListenerOptions): void;
  removeEventListener<K extends keyof Events>(type: K, listener: (event: Events[K]) => void, options?: boolean | EventListenerOptions): void;
}

export default Mimik;
