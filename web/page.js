// The page around a face: what people press, drag and drop, led to mimik.js.
import { Mimik, whyNot } from "./mimik.js";

const $ = (id) => document.getElementById(id);
const canvas = $("face");
const sounds = /\.(tsv|csv|txt|xml|jsonl?|ndjson|marks|textgrid|lab|phn|pho|lbl|segs|srt|vtt)$/i;
let face;
let info;
let keys = new Map();
let saying = 0;
let audio; // what sounds are played by

/** Tells something for a moment; screen readers read it out. */
function say(text, ms = 4000) {
  const line = document.createElement("span");
  line.textContent = text;
  $("says").replaceChildren(line);
  clearTimeout(saying);
  saying = setTimeout(() => $("says").replaceChildren(), ms);
}

/** Runs something of the library's, and tells what it complains about. */
async function attempt(what) {
  try {
    return await what();
  } catch (error) {
    say(error.message, 9000);
    return undefined;
  }
}

function cover(text, share) {
  $("veil").hidden = text === undefined;
  $("why").textContent = text ?? "";
  $("progress").hidden = share === undefined;
  if (share !== undefined) $("progress").value = share;
}

function button(text, key, press) {
  const made = document.createElement("button");
  made.textContent = text;
  made.setAttribute("aria-pressed", "false");
  if (key) {
    const shown = document.createElement("kbd");
    shown.textContent = key;
    made.append(shown);
    made.setAttribute("aria-keyshortcuts", key);
  }
  made.addEventListener("click", press);
  return made;
}

function choices(select, words, chosen) {
  select.replaceChildren(
    ...words.map((word) => {
      const made = document.createElement("option");
      made.value = word;
      made.textContent = word === "auto" ? (select.id === "quality" ? "by the device" : "its own") : word;
      return made;
    }),
  );
  select.value = chosen ?? words[0];
}

/** What the address says from now on; not at once, since browsers allow few changes a second. */
let noting = 0;
function note() {
  clearTimeout(noting);
  noting = setTimeout(() => history.replaceState(null, "", "#" + face.link()), 400);
}

function press(name) {
  attempt(() => face.press(name));
  for (const made of $("poses").children) made.setAttribute("aria-pressed", String(made.dataset.pose === name));
  sliders();
  note();
}

const shown = (control, value) => (control.unit === "weight" ? value.toFixed(2) : value.toFixed(1) + (control.unit === "degrees" ? "°" : ""));

/** Rows of sliders, a group after the other; those that a search does not name are left out. */
function fillSliders() {
  const words = $("search").value.toLowerCase().split(/\s+/).filter(Boolean);
  const groups = new Map();
  for (const control of info.controls) {
    const text = `${control.name} ${control.group}`.toLowerCase();
    if (!words.every((word) => text.includes(word))) continue;
    if (!groups.has(control.group)) groups.set(control.group, []);
    groups.get(control.group).push(control);
  }
  const made = [...groups].map(([group, controls]) => {
    const box = document.createElement("details");
    box.open = words.length > 0;
    const title = document.createElement("summary");
    title.textContent = `${group || "others"} (${controls.length})`;
    box.append(title, ...controls.map(slider));
    return box;
  });
  if (!made.length) {
    const none = document.createElement("p");
    none.textContent = "No slider of that name.";
    made.push(none);
  }
  $("sliders").replaceChildren(...made);
}

function slider(control) {
  const row = document.createElement("div");
  row.className = "slider";
  const label = document.createElement("label");
  const value = document.createElement("output");
  const input = document.createElement("input");
  const id = `control-${control.name}`;
  label.textContent = control.name;
  label.htmlFor = input.id = id;
  value.htmlFor = id;
  value.textContent = shown(control, control.value);
  Object.assign(input, { type: "range", min: control.min, max: control.max, step: "any", value: control.value });
  input.dataset.control = control.name;
  input.addEventListener("input", () => {
    value.textContent = shown(control, Number(input.value));
    attempt(() => face.set({ [control.name]: Number(input.value) }));
    note();
  });
  // Twice on a slider puts it back.
  input.addEventListener("dblclick", () => {
    input.value = control.default;
    input.dispatchEvent(new Event("input"));
  });
  row.append(label, value, input);
  return row;
}

/** Sliders where the face is heading. */
function sliders() {
  info = face.info();
  for (const control of info.controls) {
    const input = $(`control-${control.name}`);
    if (!input || input === document.activeElement) continue;
    input.value = control.value;
    input.previousElementSibling.textContent = shown(control, control.value);
  }
}

/** Everything that depends on which avatar there is. */
function fill() {
  info = face.info();
  keys = new Map(info.poses.filter((pose) => pose.key).map((pose) => [pose.key.toLowerCase(), pose.name]));
  $("poses").replaceChildren(
    ...info.poses.map((pose) => {
      const made = button(pose.name, pose.key, () => press(pose.name));
      made.dataset.pose = pose.name;
      return made;
    }),
  );
  $("clips-box").hidden = !info.clips.length;
  $("clips").replaceChildren(...info.clips.map((clip) => button(clip.name, undefined, () => attempt(() => face.play(clip.name)))));
  $("person").hidden = !info.identity.axes.length;
  for (const select of document.querySelectorAll("[data-look]")) {
    choices(select, ["auto", ...info.options[select.id]], info.look[select.id] ?? "auto");
  }
  choices($("life"), info.options.life, info.life);
  const count = (number, what) => `${number.toLocaleString("en")} ${what}`;
  $("about").textContent = `${info.name.replace(/\.zip$/, "")}: ${count(info.triangles, "triangles")}, ${count(info.controls.length, "sliders")}, ${count(info.strands ?? 0, "strands of hair")}, ${info.quality ?? "no"} quality`;
  $("notes").textContent = info.notes.length ? `Noted while reading: ${info.notes.slice(0, 5).join("; ")}` : "";
  fillSliders();
}

async function open(file) {
  cover(`Reading ${file.name}`);
  // Let the words be seen before the library is busy.
  await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
  const done = await attempt(() => face.load(file).then(() => true));
  showMicrophone();
  cover();
  if (!done) return;
  fill();
  say(`${file.name} is here.`);
  history.replaceState(null, "", location.pathname + location.search);
}

async function speak(file) {
  await attempt(async () => {
    if (sounds.test(file.name)) {
      face.speak(await file.text());
      return;
    }
    const context = (audio ??= new AudioContext());
    await context.resume();
    const buffer = await context.decodeAudioData(await file.arrayBuffer()).catch(() => {
      throw new Error(`${file.name}: expected a sound that this browser plays, found another file`);
    });
    say(`She speaks ${file.name}.`);
    face.speak(buffer, { context });
  });
  showMicrophone();
}

function showMicrophone() {
  $("microphone").setAttribute("aria-pressed", String(face.listening));
}

function listenToPeople() {
  $("sound").addEventListener("change", ({ target }) => {
    if (target.files[0]) speak(target.files[0]);
    target.value = "";
  });
  $("open").addEventListener("change", ({ target }) => {
    if (target.files[0]) open(target.files[0]);
    target.value = "";
  });
  $("hush").addEventListener("click", () => {
    face.hush();
    showMicrophone();
  });
  $("microphone").addEventListener("click", async () => {
    await attempt(async () => {
      if (face.listening) face.hush();
      else await face.listen(await navigator.mediaDevices.getUserMedia({ audio: true }));
    });
    showMicrophone();
  });
  $("life").addEventListener("change", ({ target }) => {
    attempt(() => face.life(target.value));
    note();
  });
  for (const select of document.querySelectorAll("[data-look]")) {
    select.addEventListener("change", () => {
      attempt(() => face.look({ [select.id]: select.value }));
      note();
    });
  }
  $("someone").addEventListener("click", () => {
    attempt(() => face.identity(`seed:${Math.floor(Math.random() * 100000)}`));
    note();
  });
  $("herself").addEventListener("click", () => {
    attempt(() => face.identity(""));
    note();
  });
  $("search").addEventListener("input", fillSliders);
  $("save").addEventListener("click", () =>
    attempt(async () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(await face.picture());
      link.download = "face.png";
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }),
  );
  $("link").addEventListener("click", async () => {
    const address = `${location.origin}${location.pathname}#${face.link()}`;
    history.replaceState(null, "", address);
    // Where a page may not write there, the address bar has it.
    const done = await navigator.clipboard?.writeText(address).then(() => true, () => false);
    say(done ? "The link to this face is copied." : "The address of this page is the link to this face.");
  });
  addEventListener("hashchange", () => attempt(async () => {
    await face.follow(location.hash);
    fill();
  }));

  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches("input[type=search], input[type=text], select")) return;
    const pose = keys.get(event.key.toLowerCase());
    if (!pose) return;
    event.preventDefault();
    press(pose);
  });
  canvas.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] };
    if (turns[event.key]) face.orbit(...turns[event.key]);
    else if (event.key === "+" || event.key === "-") face.orbit(0, 0, event.key === "+" ? 0.92 : 1 / 0.92);
    else if (event.key === "Home") face.front();
    else return;
    event.preventDefault();
    note();
  });

  // One finger or the mouse turns, two come nearer.
  const fingers = new Map();
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) {
      if ($("follow").checked) face.lookToward(event.clientX, event.clientY);
      return;
    }
    const apart = fingers.size === 2 ? spread() : 0;
    const now = { x: event.clientX, y: event.clientY };
    fingers.set(event.pointerId, now);
    if (apart) face.orbit(0, 0, apart / Math.max(spread(), 1));
    else face.orbit((before.x - now.x) * 0.35, (now.y - before.y) * 0.35);
    note();
  });
  for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("dblclick", () => {
    face.front();
    note();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    face.orbit(0, 0, Math.exp(event.deltaY * 0.001));
    note();
  }, { passive: false });
  $("follow").addEventListener("change", ({ target }) => target.checked || face.lookAt());

  addEventListener("dragover", (event) => {
    event.preventDefault();
    $("stage").classList.add("drop");
  });
  addEventListener("dragleave", () => $("stage").classList.remove("drop"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    $("stage").classList.remove("drop");
    const file = event.dataTransfer.files[0];
    if (!file) return;
    if (file.type.startsWith("audio/") || sounds.test(file.name)) speak(file);
    else open(file);
  });
}

async function start() {
  const why = whyNot();
  if (why) return cover(why);
  try {
    face = await Mimik.create(canvas, {
      link: location.hash,
      onprogress: (share) => cover(share < 1 ? "Loading" : "Waking her up", share),
    });
  } catch (error) {
    return cover(error.message);
  }
  face.addEventListener("lost", () => say("The graphics device is lost. It is opened again."));
  face.addEventListener("restored", () => say("Here she is again."));
  face.addEventListener("error", ({ detail }) => say(detail.message, 9000));
  // She lives, unless somebody wants less motion or the link is of a moment.
  if (!location.hash && !matchMedia("(prefers-reduced-motion: reduce)").matches) face.life("calm");
  globalThis.face = face; // for whoever opens the console
  fill();
  listenToPeople();
  cover();
  document.body.dataset.ready = "yes";
}

start();
