// Times the library and three.js with the same GLB in the same Chromium, by turns:
// bench-web.mjs PAGE WORK FRAMES ROUNDS
import { readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { chromium } from "playwright-core";
import { spent } from "./web-load.mjs";
import { serve } from "./web-server.mjs";

const [folder, work, frames, rounds] = process.argv.slice(2);
const SIZE = 512;
// Each frame moves shapes and shows the whole picture at four samples a pixel; its time is from asking for it
// until the device has drawn it. Without the first five, in which programs are still compiled.
const shared = `
  const canvas = document.querySelector("canvas");
  async function time(frame) {
    const times = [];
    for (let i = 0; i < ${frames} + 5; i++) {
      await new Promise(requestAnimationFrame);
      const began = performance.now();
      await frame(0.5 + 0.5 * Math.sin(i / 5));
      times.push(performance.now() - began);
    }
    return times.slice(5);
  }
  const tell = (told) => globalThis.told = told;
`;
const page = (body) => `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">
<canvas width="${SIZE}" height="${SIZE}" style="width: ${SIZE}px; height: ${SIZE}px"></canvas>
<script type="importmap">{ "imports": { "three": "/node_modules/three/build/three.module.js", "three/webgpu": "/node_modules/three/build/three.webgpu.js",
  "three/addons/": "/node_modules/three/examples/jsm/" } }</script>
<script type="module">${shared}${body}</script>`;

const ours = (quality) => page(`
  import init, { Face } from "/avatar_web.js";
  const began = performance.now();
  const [glb, { memory }] = await Promise.all([fetch("/face.glb").then((file) => file.arrayBuffer()), init({ module_or_path: fetch("/avatar_web_bg.wasm") })]);
  const face = new Face("face.glb", new Uint8Array(glb));
  face.look("quality", "${quality}");
  face.show(await face.open(canvas));
  face.advance(0);
  face.draw(0, true);
  await face.done();
  const loaded = performance.now() - began;
  const times = await time(async (share) => {
    for (const [name, value] of [["mouthSmileLeft", share], ["mouthSmileRight", share], ["mouthFunnel", share * 0.5]]) face.set(name, value);
    face.advance(0.1);
    face.draw(0.1, true);
    await face.done();
  });
  tell({ times, loaded, heap: performance.memory.usedJSHeapSize + memory.buffer.byteLength });
`);
const three = (which, shadows) => page(`
  import * as THREE from "${which === "WebGPU" ? "three/webgpu" : "three"}";
  import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
  const began = performance.now();
  const renderer = new THREE.${which}Renderer({ canvas, antialias: true });
  await renderer.init?.();
  renderer.setSize(${SIZE}, ${SIZE}, false);
  const { scene: model } = await new GLTFLoader().loadAsync("/face.glb");
  const scene = new THREE.Scene();
  let key;
  scene.add(model, new THREE.HemisphereLight(0xffffff, 0x444444, 1));
  for (const [x, y, z, power] of [[0.5, 0.42, 0.85, 3], [-0.9, 0.1, 0.6, 0.5], [-0.6, 0.5, -0.9, 1]]) {
    const lamp = new THREE.DirectionalLight(0xffffff, power);
    lamp.position.set(x, y, z);
    scene.add(lamp);
    // The key lamp's, at the size that the library's have.
    if (${shadows} && power === 3) key = lamp;
  }
  const box = new THREE.Box3().setFromObject(model);
  const [center, size] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3())];
  const camera = new THREE.PerspectiveCamera(24, 1, size.y / 100, size.y * 100);
  camera.position.set(center.x, center.y, center.z + size.y * 2.7);
  camera.lookAt(center);
  if (key) {
    renderer.shadowMap.enabled = true;
    key.castShadow = true;
    key.position.sub(new THREE.Vector3()).normalize().multiplyScalar(size.y * 2).add(center);
    key.target.position.copy(center);
    scene.add(key.target);
    key.shadow.mapSize.set(1024, 1024);
    Object.assign(key.shadow.camera, { left: -size.y, right: size.y, top: size.y, bottom: -size.y, near: size.y / 10, far: size.y * 5 });
    model.traverse((mesh) => mesh.isMesh && Object.assign(mesh, { castShadow: true, receiveShadow: true }));
  }
  const morphed = [];
  model.traverse((mesh) => mesh.morphTargetDictionary && morphed.push(mesh));
  const pixel = new Uint8Array(4);
  const frame = async (share) => {
    for (const mesh of morphed) {
      for (const [name, value] of [["mouthSmileLeft", share], ["mouthSmileRight", share], ["mouthFunnel", share * 0.5]]) {
        const index = mesh.morphTargetDictionary[name];
        if (index !== undefined) mesh.morphTargetInfluences[index] = value;
      }
    }
    if (renderer.renderAsync) {
      await renderer.renderAsync(scene, camera);
      await renderer.backend.device.queue.onSubmittedWorkDone();
    } else {
      renderer.render(scene, camera);
      const gl = renderer.getContext();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    }
  };
  await frame(0);
  const loaded = performance.now() - began;
  const times = await time(frame);
  tell({ times, loaded, heap: performance.memory.usedJSHeapSize });
`);

const pages = {
  "/plain.html": ours("plain"),
  "/low.html": ours("low"),
  "/medium.html": ours("medium"),
  "/WebGPU.html": three("WebGPU", false),
  "/WebGL.html": three("WebGL", false),
  "/WebGPU-shadows.html": three("WebGPU", true),
  "/WebGL-shadows.html": three("WebGL", true),
};
const server = await serve([folder, work], pages);
const glb = statSync(join(work, "face.glb")).size;
const packed = (...files) => files.reduce((sum, file) => sum + gzipSync(readFileSync(file)).length, 0);
const library = packed(join(folder, "avatar_web_bg.wasm"), join(folder, "avatar_web.js"), join(folder, "mimik.js"));
const build = join(work, "node_modules/three/build");
const loader = join(work, "node_modules/three/examples/jsm/loaders/GLTFLoader.js");
const sizes = {
  WebGPU: packed(join(build, "three.webgpu.js"), join(build, "three.core.js"), loader),
  WebGL: packed(join(build, "three.module.js"), join(build, "three.core.js"), loader),
};
const contenders = ["plain", "low", "medium", "WebGPU", "WebGL", "WebGPU-shadows", "WebGL-shadows"];
const told = Object.fromEntries(contenders.map((name) => [name, { times: [], loaded: [], heap: [] }]));
const load = [];
for (let round = 0; round < Number(rounds); round++) {
  // Each begins a round once, so that none always runs on what another has warmed up.
  const turn = round % contenders.length;
  for (const name of [...contenders.slice(turn), ...contenders.slice(0, turn)]) {
    const browser = await chromium.launch({
      executablePath: process.env.MIMIK_CHROMIUM ?? "/usr/bin/chromium",
      args: ["--no-sandbox", "--enable-unsafe-webgpu", "--enable-features=Vulkan", "--use-vulkan=swiftshader", "--use-angle=swiftshader",
        "--enable-precise-memory-info"],
    });
    const view = await browser.newPage({ viewport: { width: 560, height: 560 } });
    view.on("pageerror", (error) => console.error(`${name}: ${error.message}`));
    view.on("console", (message) => message.type() === "error" && console.error(`${name}: ${message.text()}`));
    const before = spent();
    await view.goto(`${server.address}/${name}.html`);
    await view.waitForFunction(() => globalThis.told, undefined, { timeout: 280000 });
    load.push(spent().others(before));
    const { times, loaded, heap } = await view.evaluate(() => globalThis.told);
    if (process.env.MIMIK_SHOTS) await view.screenshot({ path: join(process.env.MIMIK_SHOTS, `bench-${name}.png`) });
    await browser.close();
    told[name].times.push(...times);
    told[name].loaded.push(loaded);
    told[name].heap.push(heap);
  }
}
const median = (list) => list.toSorted((a, b) => a - b)[list.length >> 1];
const who = {
  plain: "this library, plain",
  low: "this library, low (shadows)",
  medium: "this library, medium (soft shadows, occlusion, reflections)",
  WebGPU: "three.js, WebGPURenderer",
  WebGL: "three.js, WebGLRenderer",
  "WebGPU-shadows": "three.js, WebGPURenderer, with shadows",
  "WebGL-shadows": "three.js, WebGLRenderer, with shadows",
};
console.log("| drawn by | a frame, ms: median | least | first picture, ms: median | least | memory of the page, MB | library, gzip, MB | GLB, MB |");
console.log("|---|---:|---:|---:|---:|---:|---:|---:|");
for (const name of contenders) {
  const { times, loaded, heap } = told[name];
  const bytes = (sizes[name.split("-")[0]] ?? library) / 1e6;
  const cells = [who[name], median(times).toFixed(1), Math.min(...times).toFixed(1), median(loaded).toFixed(0), Math.min(...loaded).toFixed(0)];
  console.log(`| ${[...cells, (median(heap) / 1e6).toFixed(0), bytes.toFixed(2), (glb / 1e6).toFixed(1)].join(" | ")} |`);
}
console.log();
for (const [ours, shadows] of [["plain", ""], ["low", "-shadows"]]) {
  for (const [other, most] of [["WebGPU", 0.5], ["WebGL", 1]]) {
    const of = (pick) => (pick(told[ours].times) / pick(told[other + shadows].times)).toFixed(2);
    console.log(`${who[ours]} by ${who[other + shadows]}: ${of(median)} by medians, ${of((list) => Math.min(...list))} by least; ${most} was asked for`);
  }
}
console.log(`${rounds} rounds of ${frames} frames of ${SIZE} × ${SIZE} pixels, 4 samples; others took ${(median(load) * 100).toFixed(0)}% of the processors (median), at most ${(Math.max(...load) * 100).toFixed(0)}%`);
server.close();
