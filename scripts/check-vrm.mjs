// Has three-vrm read VRM files and compares what it makes of expressions and gazes; called by check-vrm.
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { Euler, MathUtils } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { VRMLoaderPlugin } from '@pixiv/three-vrm';

globalThis.self = globalThis;

// Of weights, and of degrees.
const farthest = { weight: 1e-5, degrees: 1e-3 };

async function open(path) {
    const bytes = readFileSync(path);
    const loader = new GLTFLoader().register(parser => new VRMLoaderPlugin(parser));
    const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
    return gltf.userData.vrm;
}

// What its bones are turned by, in the axes of a model that looks along +Z: yaw and pitch in degrees.
function turned(vrm, bone) {
    const euler = new Euler().setFromQuaternion(vrm.humanoid.getRawBoneNode(bone).quaternion, 'YXZ');
    // Version 0 looks along -Z.
    const sign = vrm.meta.metaVersion === '0' ? -1 : 1;
    return [MathUtils.radToDeg(euler.y), sign * MathUtils.radToDeg(euler.x)];
}

const totals = { files: 0, weights: 0, gazes: 0 };
const worst = { weight: 0, degrees: 0 };
for (const path of process.argv.slice(2)) {
    const expected = JSON.parse(readFileSync(path.replace(/vrm$/, 'json'), 'utf8'));
    const vrm = await open(path);
    const fail = text => {
        console.error(`${basename(path)}: ${text}`);
        process.exit(1);
    };
    const compare = (kind, found, ours, what) => {
        const off = Math.abs(found - ours);
        worst[kind] = Math.max(worst[kind], off);
        if (!(off <= farthest[kind])) fail(`${what}: three-vrm ${found}, here ${ours}`);
    };
    const manager = vrm.expressionManager;
    const names = manager.expressions.map(expression => expression.expressionName).sort();
    if (`${names}` !== `${[...expected.expressions].sort()}`) fail(`three-vrm ${names}, here ${expected.expressions}`);
    const face = vrm.scene.getObjectByName('face');
    for (const { values, weights } of expected.weights) {
        names.forEach(name => manager.setValue(name, 0));
        values.forEach(([name, value]) => manager.setValue(name, value));
        manager.update();
        weights.forEach((ours, shape) => {
            compare('weight', face.morphTargetInfluences[shape], ours, `shape ${shape} at ${JSON.stringify(values)}`);
            totals.weights += 1;
        });
    }
    const applier = vrm.lookAt.applier;
    if (applier.constructor.type === 'bone') {
        // Its eyes of bone take the range of looking up where they look down, unlike its own eyes of
        // expressions.
        [applier.rangeMapVerticalDown, applier.rangeMapVerticalUp] = [applier.rangeMapVerticalUp, applier.rangeMapVerticalDown];
    }
    for (const { yaw, pitch, bone, found } of expected.looks) {
        const what = `gaze ${yaw} ${pitch}`;
        if (bone !== (applier.constructor.type === 'bone')) fail(`${what}: another kind of eyes`);
        applier.applyYawPitch(yaw, pitch);
        totals.gazes += 1;
        if (bone) {
            ['leftEye', 'rightEye'].forEach((eye, side) => turned(vrm, eye).forEach((angle, axis) => {
                compare('degrees', angle, found[side][axis], `${eye} at ${what}`);
            }));
        } else {
            // Its expressions take values up to 1.
            found.forEach(([name, value]) => {
                const known = manager.getExpression(name);
                if (known) compare('weight', known.weight, Math.min(value, 1), `${name} at ${what}`);
            });
        }
    }
    totals.files += 1;
}
console.log(`three-vrm agrees on ${totals.files} files, ${totals.weights} weights (within ${worst.weight}), ` +
    `${totals.gazes} gazes (within ${worst.degrees} degrees)`);
