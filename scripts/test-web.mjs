// Uses the page in Chromium as people do, and fails where it does not hold:
// test-web.mjs PAGE VIEWER SHOTS FACE
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { spent } from "./web-load.mjs";
import { serve } from "./web-server.mjs";

const [folder, viewer, shots, pack] = process.argv.slice(2);
const readme = readFileSync(join(folder, "README.md"), "utf8");
const embedded = readme.match(/```html\n([\s\S]*?)```/)?.[1];
// Steps whose name holds this text, where not all are wanted.
const only = process.env.MIMIK_WEB_ONLY ?? "";
const server = await serve([folder, shots], { "/embedded.html": embedded ?? "", "/favicon.ico": "" });
writeFileSync(join(shots, "voice.wav"), voice(4));
const browser = await chromium.launch({
  executablePath: process.env.MIMIK_CHROMIUM ?? "/usr/bin/chromium",
  args: [
    "--no-sandbox",
    "--enable-unsafe-webgpu",
    "--enable-features=Vulkan",
    "--use-vulkan=swiftshader",
    "--use-angle=swiftshader",
    "--autoplay-policy=no-user-gesture-required",
    "--enable-precise-memory-info",
    "--js-flags=--expose-gc",
    // At the microphone is somebody who says vowels, over and over.
    "--use-fake-ui-for-media-stream",
    "--use-fake-device-for-media-stream",
    `--use-file-for-fake-audio-capture=${join(shots, "voice.wav")}`,
  ],
});

// Nothing takes that long, on machines however busy.
const PATIENCE = { timeout: 180_000 };
/** Milliseconds from the bytes to the first picture. */
const FIRST_PICTURE_MS = 2000;
/** Share of the processors that others may take while that is judged. */
const QUIET = 0.1;

let failures = 0;
function expect(holds, expected, found) {
  if (!holds) throw new Error(`expected ${expected}, found ${typeof found === "string" ? found : JSON.stringify(found)}`);
}
async function step(name, what) {
  if (!name.includes(only) && !name.includes("opens")) return;
  const began = performance.now();
  try {
    const told = (await what()) ?? "";
    console.log(`ok    ${name} (${((performance.now() - began) / 1000).toFixed(1)} s) ${told}`);
  } catch (error) {
    failures += 1;
    console.log(`FAILED ${name}: ${error.message}`);
  }
}
const complaints = [];
async function newPage(address, size = { width: 720, height: 420 }) {
  const page = await browser.newPage({ viewport: size });
  page.setDefaultTimeout(PATIENCE.timeout);
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(`${address}: ${message.text()}`);
  });
  page.on("pageerror", (error) => complaints.push(`${address}: ${error.message}`));
  await page.goto(server.address + address);
  return page;
}
const frames = (page) => page.evaluate(() => face.info().frames);
/** Waits until nothing is drawn any more. */
async function settle(page) {
  await page.evaluate(async () => {
    for (let still = 0, before = -1; still < 3; ) {
      await new Promise((resolve) => setTimeout(resolve, 150));
      const now = face.info().frames;
      // A face that lives is never still.
      const rests = face.still || face.info().life !== "off";
      still = now === before && face.arrived && rests ? still + 1 : 0;
      before = now;
    }
  });
}
const value = (page, control) => page.evaluate((name) => {
  const { controls } = face.info();
  return face.state().values[controls.findIndex((one) => one.name === name)];
}, control);

/** From now on the page itself notes the most that a control is above its value now: in each frame. */
const watch = (page, control) => page.evaluate((name) => {
  const index = face.info().controls.findIndex((one) => one.name === name);
  const [rest] = [face.state().values[index]];
  globalThis.most = 0;
  const look = () => {
    globalThis.most = Math.max(globalThis.most, face.state().values[index] - rest);
    requestAnimationFrame(look);
  };
  look();
}, control);
const most = (page) => page.evaluate(() => globalThis.most);

/** A mono WAV of vowels with pauses: a voice's pulses through two resonances. */
function voice(seconds, rate = 16000) {
  const samples = new Float32Array(seconds * rate);
  const vowels = [[730, 1090], [270, 2290], [570, 840]];
  const state = [[0, 0], [0, 0]];
  for (let i = 0; i < samples.length; i++) {
    const secs = i / rate;
    const isLoud = secs % 0.5 < 0.35;
    const formants = vowels[Math.floor(secs / 0.5) % 3];
    let sum = 0;
    const pulse = i % Math.floor(rate / 120) === 0 && isLoud ? 1 : 0;
    formants.forEach((hz, k) => {
      const r = Math.exp(-Math.PI * 90 / rate);
      const y = pulse + 2 * r * Math.cos(2 * Math.PI * hz / rate) * state[k][0] - r * r * state[k][1];
      state[k] = [y, state[k][0]];
      sum += y;
    });
    samples[i] = sum * 0.12;
  }
  const bytes = Buffer.alloc(44 + samples.length * 2);
  bytes.write("RIFF", 0);
  bytes.writeUInt32LE(36 + samples.length * 2, 4);
  bytes.write("WAVEfmt ", 8);
  [16, 1 | (1 << 16), rate, rate * 2, 2 | (16 << 16)].forEach((number, k) => bytes.writeUInt32LE(number, 16 + 4 * k));
  bytes.write("data", 36);
  bytes.writeUInt32LE(samples.length * 2, 40);
  samples.forEach((sample, i) => bytes.writeInt16LE(Math.max(-1, Math.min(1, sample)) * 32767, 44 + 2 * i));
  return bytes;
}

const page = await newPage("/");
await step("the page opens and shows the face", async () => {
  await page.waitForSelector("body[data-ready]", PATIENCE);
  const { adapter, quality, vertices } = await page.evaluate(() => face.info());
  expect(vertices > 10000, "a face with its vertices", vertices);
  await page.screenshot({ path: join(shots, "page.png") });
  return `${adapter || "adapter without a name"}, ${quality}`;
});

await step("the first picture", async () => {
  // The page of the step before would draw meanwhile.
  await page.evaluate(() => face.life("off"));
  await settle(page);
  const told = [];
  const quiet = [];
  for (let i = 0; i < 4 && quiet.length < 2; i++) {
    const before = spent();
    const other = await newPage("/#life=off", { width: 900, height: 560 });
    await other.waitForSelector("body[data-ready]", PATIENCE);
    const after = spent();
    const { times } = await other.evaluate(() => face.info());
    await other.close();
    const others = after.others(before);
    const first = times.read + times.show;
    told.push(`${first.toFixed(0)} ms (read ${times.read.toFixed(0)}, shown ${times.show.toFixed(0)}) beside others with ${(others * 100).toFixed(0)}%`);
    if (others <= QUIET) quiet.push(first);
    // Nobody has to wait until those are done.
    if (others > 3 * QUIET) break;
  }
  const list = told.join("; ");
  if (process.env.MIMIK_WEB_UNTIMED === "1") return `NOT JUDGED, as it was asked for: ${list}`;
  if (!quiet.length) return `NOT JUDGED, for others use this machine as well: ${list}`;
  expect(Math.min(...quiet) <= FIRST_PICTURE_MS, `a first picture within ${FIRST_PICTURE_MS} ms after its bytes`, list);
  return list;
});

await step("nothing is drawn while nothing moves", async () => {
  await page.evaluate(() => face.life("off"));
  await settle(page);
  const before = await frames(page);
  await page.waitForTimeout(1500);
  const drawn = (await frames(page)) - before;
  expect(drawn === 0, "0 frames in 1.5 s", drawn);
});

await step("poses by key and button", async () => {
  await page.focus("#face");
  const arrived = page.evaluate(() => new Promise((resolve) => face.addEventListener("arrived", () => resolve(true), { once: true })));
  await page.keyboard.press("1");
  expect(await arrived, "the event arrived", false);
  const smile = await value(page, "mouthSmileLeft");
  expect(Math.abs(smile - 0.95) < 1e-6, "mouthSmileLeft at 0.95", smile);
  expect((await page.getAttribute("[data-pose=smile]", "aria-pressed")) === "true", "the button of smile pressed", "not");
  await settle(page);
  await page.screenshot({ path: join(shots, "smile.png") });
  await page.click("[data-pose=neutral]");
  await settle(page);
  expect((await value(page, "mouthSmileLeft")) === 0, "mouthSmileLeft at 0", await value(page, "mouthSmileLeft"));
});

await step("a slider that was searched for", async () => {
  await page.fill("#search", "jaw open");
  const slider = page.locator("#sliders input").first();
  await slider.evaluate((input) => {
    input.value = input.max;
    input.dispatchEvent(new Event("input"));
  });
  await settle(page);
  const [name, most] = await slider.evaluate((input) => [input.dataset.control, Number(input.max)]);
  expect(Math.abs((await value(page, name)) - most) < 1e-4, `${name} at ${most}`, await value(page, name));
  await page.screenshot({ path: join(shots, "jaw.png") });
  await page.fill("#search", "");
  await page.keyboard.press("Escape");
});

await step("the address is a link to the face", async () => {
  await page.waitForTimeout(600);
  const link = await page.evaluate(() => location.hash);
  expect(link.includes("set="), "controls in the address", link);
  const other = await newPage(`/${link}`);
  await other.waitForSelector("body[data-ready]", PATIENCE);
  const bits = (which) => which.evaluate(() => [...new Uint32Array(face.state().bones.buffer)].join());
  await settle(other);
  expect((await bits(page)) === (await bits(other)), "the same bones bit for bit", "others");
  await other.close();
  await page.evaluate(() => face.press("neutral"));
});

await step("life", async () => {
  await page.selectOption("#life", "lively");
  const before = await page.evaluate(() => [...face.state().values]);
  const began = await frames(page);
  await page.waitForTimeout(4000);
  const after = await page.evaluate(() => [...face.state().values]);
  const moved = after.filter((number, index) => number !== before[index]).length;
  expect(moved > 5, "more than five controls that live", moved);
  const drawn = (await frames(page)) - began;
  await page.selectOption("#life", "off");
  await settle(page);
  return `${(drawn / 4).toFixed(1)} frames a second`;
});

await step("she speaks a sound", async () => {
  const before = await value(page, "jaw.open");
  await page.evaluate(() => {
    globalThis.spoken = false;
    face.addEventListener("spoken", () => (globalThis.spoken = true), { once: true });
  });
  await page.setInputFiles("#sound", { name: "voice.wav", mimeType: "audio/wav", buffer: voice(2) });
  await watch(page, "jaw.open");
  await page.waitForFunction(() => globalThis.spoken || globalThis.most > 1, undefined, PATIENCE);
  await page.screenshot({ path: join(shots, "speaks.png") });
  await page.waitForFunction(() => globalThis.spoken, undefined, PATIENCE);
  expect((await most(page)) > 0.05, "a jaw that opens", await most(page));
  await settle(page);
  expect(Math.abs((await value(page, "jaw.open")) - before) < 1e-3, "a mouth at rest after it", await value(page, "jaw.open"));
});

await step("she says what comes from a microphone", async () => {
  await watch(page, "jaw.open");
  await page.click("#microphone");
  await page.waitForFunction(() => globalThis.most > 0.5, undefined, PATIENCE);
  expect((await page.getAttribute("#microphone", "aria-pressed")) === "true", "a pressed button", "none");
  await page.click("#microphone");
  expect(!(await page.evaluate(() => face.listening)), "a microphone that is off", "one that is on");
  await settle(page);
});

await step("looks and somebody else", async () => {
  await page.selectOption("#hair", "bob");
  await page.selectOption("#light", "dramatic");
  await page.evaluate(() => face.identity("seed:7"));
  await settle(page);
  await page.screenshot({ path: join(shots, "looks.png") });
  const wrong = await page.evaluate(() => {
    try {
      face.look({ hair: "bobb" });
    } catch (error) {
      return error.message;
    }
  });
  expect(wrong?.includes('did you mean "bob"'), "the library's words for a wrong name", wrong);
  await page.evaluate(() => {
    face.identity("");
    face.look({ hair: "auto", light: "auto" });
  });
});

await step("a lost device, and back", async () => {
  const before = await page.evaluate(() => {
    globalThis.lost = 0;
    face.addEventListener("lost", () => (globalThis.lost += 1), { once: true });
    globalThis.restored = new Promise((resolve) => face.addEventListener("restored", () => resolve(true), { once: true }));
    face.press("surprise");
    const bones = [...face.state().bones];
    face.lose();
    return bones.length;
  });
  expect(await page.evaluate(() => globalThis.restored), "the event restored", "none");
  expect((await page.evaluate(() => globalThis.lost)) === 1, "the event lost, once", "another number");
  await settle(page);
  expect((await page.evaluate(() => face.state().bones.length)) === before, "the same face", "another");
  await page.screenshot({ path: join(shots, "restored.png") });
  await page.evaluate(() => face.press("neutral"));
});

await step("the picture and the numbers are the viewer's", async () => {
  const told = [];
  for (const [pose, settings] of [["smile", []], ["surprise", ["jaw.open=7.5"]]]) {
    const set = settings.flatMap((setting) => ["--set", setting]);
    const file = join(shots, `viewer-${pose}.png`);
    const posed = ["--pose", pose, ...set];
    execFileSync(viewer, ["render", pack, ...posed, "--quality", "low", "--size", "480x480", "--out", file], { stdio: "pipe" });
    const bones = JSON.parse(execFileSync(viewer, ["bones", pack, ...posed, "--out", "-"], { stdio: "pipe", maxBuffer: 1 << 26 }));
    await page.evaluate(([pose, settings]) => {
      face.look({ quality: "low" });
      face.front();
      face.press(pose);
      settings.forEach((setting) => face.set({ [setting.split("=")[0]]: Number(setting.split("=")[1]) }));
    }, [pose, settings]);
    await settle(page);
    const state = await page.evaluate(() => {
      const { controls, names: { bones, shapes } } = face.info();
      const state = face.state();
      return {
        bones,
        shapes,
        controls: controls.map((control) => control.name),
        values: [...state.values],
        matrices: [...state.bones],
        weights: [...state.weights],
      };
    });
    // To the bit, zeros with their signs: a number's shortest text leads to the same bits.
    let compared = 0;
    const same = (what, ours, theirs) => {
      expect(Object.is(ours, Math.fround(theirs)), `${pose}: ${what} of ${theirs}`, ours);
      compared += 1;
    };
    const script = ["--script", `0 ${pose}`, "--hz", "1", "--duration", "3", "--out", "-"];
    const rows = execFileSync(viewer, ["trace", pack, ...script], { stdio: "pipe" }).toString().trim().split("\n");
    const numbers = rows.at(-1).split(",").slice(1).map(Number);
    const told_values = Object.fromEntries(settings.map((setting) => setting.split("=")));
    rows[0].split(",").slice(1).forEach((name, index) => {
      // That table has no negative zeros.
      same(name, state.values[state.controls.indexOf(name)] + 0, Number(told_values[name] ?? numbers[index]));
    });
    expect(compared === state.controls.length, `${state.controls.length} controls`, compared);
    // Rows of the viewer's matrices against our columns.
    state.bones.forEach((name, index) => {
      const { skin } = bones.joints.find((joint) => joint.name === name);
      for (let row = 0; row < 3; row++) {
        for (let column = 0; column < 4; column++) {
          same(`${name} ${row},${column}`, state.matrices[12 * index + 3 * column + row], skin[4 * row + column]);
        }
      }
    });
    state.shapes.forEach((name, index) => {
      same(name, state.weights[index], bones.weights[name] ?? bones.weights[{ SSmile: "smile", Frown: "frown" }[name]]);
    });
    const ssim = await page.evaluate(async ([pose]) => {
      const bytes = await (await fetch(`/viewer-${pose}.png`)).blob();
      const bitmap = await createImageBitmap(bytes, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
      context.drawImage(bitmap, 0, 0);
      const gray = ({ data }) => Float32Array.from({ length: data.length / 4 }, (_, i) =>
        0.2126 * data[4 * i] + 0.7152 * data[4 * i + 1] + 0.0722 * data[4 * i + 2]);
      const a = gray(context.getImageData(0, 0, bitmap.width, bitmap.height));
      const b = gray(await face.pixels(bitmap.width, bitmap.height));
      // Wang et al. 2004, over windows of 8 × 8 pixels, every fourth.
      const [c1, c2, size] = [(0.01 * 255) ** 2, (0.03 * 255) ** 2, 8];
      let [sum, count] = [0, 0];
      for (let y = 0; y + size <= bitmap.height; y += 4) {
        for (let x = 0; x + size <= bitmap.width; x += 4) {
          let [sa, sb, saa, sbb, sab] = [0, 0, 0, 0, 0];
          for (let j = 0; j < size; j++) {
            for (let i = 0; i < size; i++) {
              const at = (y + j) * bitmap.width + x + i;
              sa += a[at];
              sb += b[at];
              saa += a[at] ** 2;
              sbb += b[at] ** 2;
              sab += a[at] * b[at];
            }
          }
          const n = size * size;
          const [ma, mb] = [sa / n, sb / n];
          const [va, vb, vab] = [saa / n - ma * ma, sbb / n - mb * mb, sab / n - ma * mb];
          sum += ((2 * ma * mb + c1) * (2 * vab + c2)) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
          count += 1;
        }
      }
      return sum / count;
    }, [pose]);
    const picture = await page.evaluate(async () => {
      const bytes = new Uint8Array(await (await face.picture(480, 480)).arrayBuffer());
      return btoa(bytes.reduce((text, byte) => text + String.fromCharCode(byte), ""));
    });
    writeFileSync(join(shots, `page-${pose}.png`), Buffer.from(picture, "base64"));
    expect(ssim >= 0.99, `${pose}: SSIM of at least 0.99`, ssim);
    told.push(`${pose}: SSIM ${ssim.toFixed(4)}, ${compared} values, bones and shapes bit for bit`);
  }
  return told.join("; ");
});

/** Drops a file on the page, and waits until it is shown. */
async function drop(address, name, type) {
  await page.evaluate(async ([address, name, type]) => {
    const bytes = await (await fetch(address)).arrayBuffer();
    const data = new DataTransfer();
    data.items.add(new File([bytes], name, { type }));
    document.getElementById("face").dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  }, [address, name, type]);
  await page.waitForFunction((name) => face.info().name === name && document.getElementById("veil").hidden, name, PATIENCE);
  await settle(page);
  return page.evaluate(() => face.info());
}

await step("a GLB, an OBJ and a pack as zip are dropped", async () => {
  execFileSync(viewer, ["convert", "--out", join(shots, "face.glb")], { stdio: "pipe" });
  const glb = await drop("/face.glb", "face.glb", "model/gltf-binary");
  await page.screenshot({ path: join(shots, "glb.png") });
  expect(glb.controls.length > 50 && glb.triangles > 10000, "the face's sliders and triangles", [glb.controls.length, glb.triangles]);
  const corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]].map((corner) => `v ${corner.join(" ")}\n`).join("");
  writeFileSync(join(shots, "square.obj"), `${corners}f 1 2 3 4\n`);
  const obj = await drop("/square.obj", "square.obj", "");
  expect(obj.triangles === 2, "two triangles", obj.triangles);
  const zip = await drop("/marsienne.zip", "her.zip", "application/zip");
  expect(zip.triangles > 10000 && zip.poses.length > 20, "the face with its poses", [zip.triangles, zip.poses.length]);
});

await step("a file that is no avatar is refused in words", async () => {
  const told = await page.evaluate(() => face.load(new File(["nothing"], "face.glb")).then(() => "nothing", (error) => error.message));
  expect(told.startsWith("face.glb"), "the library's words", told);
  expect((await page.evaluate(() => face.info().triangles)) > 10000, "the face before", "none");
  return told;
});
await page.close();

await step("fifty loads without growth", async () => {
  const other = await newPage("/", { width: 420, height: 420 });
  await other.waitForSelector("body[data-ready]", PATIENCE);
  await other.evaluate(() => face.look({ quality: "plain" }));
  const measure = () => other.evaluate(async () => {
    await new Promise((resolve) => setTimeout(resolve, 300));
    globalThis.gc?.();
    return { library: face.info().bytes, page: performance.memory.usedJSHeapSize };
  });
  const memory = [];
  const processes = [];
  const loads = Number(process.env.MIMIK_WEB_LOADS ?? 50);
  await other.evaluate(async () => {
    globalThis.bytes = await (await fetch("/marsienne.zip")).arrayBuffer();
  });
  for (let i = 0; i < loads; i++) {
    await other.evaluate(() => face.load({ name: "marsienne.zip", bytes: globalThis.bytes }));
    if (i % 10 === 4 || i === loads - 1) {
      memory.push(await measure());
      processes.push(resident());
    }
  }
  await other.close();
  // What the first loads leave free is used by those that follow: half of them decide.
  const [first, half, last] = [memory[0], memory[Math.floor(memory.length / 2)], memory.at(-1)];
  expect(last.library <= half.library * 1.05, "a library that stays as large", { half, last });
  expect(last.library <= first.library * 1.25, "a library that stays nearly as large", { first, last });
  expect(last.page <= first.page + 20e6, "a page that stays as large", { first, last });
  expect(processes.at(-1) <= processes[0] * 1.25 + 100, "a browser that stays as large, in MB", processes);
  return `library ${(last.library / 1e6).toFixed(0)} MB, page ${(last.page / 1e6).toFixed(0)} MB, browser ${processes.join(", ")} MB`;
});

/** Megabytes of the browser's processes. */
function resident() {
  const lines = execFileSync("ps", ["-eo", "rss,args"], { maxBuffer: 1 << 26 }).toString().split("\n");
  return Math.round(lines.filter((line) => line.includes("chromium") && line.includes("--type=")).reduce((sum, line) => sum + parseInt(line), 0) / 1000);
}

await step("the page of the README speaks", async () => {
  expect(embedded, "a page in the README", "none");
  expect(embedded.trim().split("\n").length <= 15, "at most 15 lines", embedded.trim().split("\n").length);
  const other = await newPage("/embedded.html", { width: 480, height: 480 });
  await other.waitForFunction(() => globalThis.face?.info?.().frames > 0, undefined, PATIENCE);
  await watch(other, "jaw.open");
  await other.click("button");
  await other.waitForFunction(() => globalThis.most > 0.3, undefined, PATIENCE);
  await other.screenshot({ path: join(shots, "embedded.png") });
  await other.close();
});

await step("a browser without WebGPU is told so", async () => {
  const other = await browser.newPage();
  await other.addInitScript(() => Object.defineProperty(navigator, "gpu", { value: undefined }));
  await other.goto(server.address);
  await other.waitForFunction(() => document.getElementById("why").textContent.includes("WebGPU"));
  await other.close();
});

await step("a small touch screen, in the dark", async () => {
  const context = await browser.newContext({ viewport: { width: 390, height: 760 }, deviceScaleFactor: 2, hasTouch: true, colorScheme: "dark" });
  const other = await context.newPage();
  await other.goto(`${server.address}/#set=mouthSmileLeft:0.9,mouthSmileRight:0.9`);
  await other.waitForSelector("body[data-ready]", PATIENCE);
  await settle(other);
  await other.screenshot({ path: join(shots, "touch.png") });
  const [width, css] = await other.evaluate(() => [document.querySelector("canvas").width, document.querySelector("canvas").clientWidth]);
  expect(width === 2 * css, "two pixels for each of CSS", [width, css]);
  await context.close();
});

await step("the console is without errors", () => expect(complaints.length === 0, "no complaint", complaints.slice(0, 5)));
await browser.close();
server.close();
console.log(failures ? `${failures} failed` : "all of it holds");
process.exit(failures ? 1 : 0);
