// Has three-vrm read VRM files and compares what it makes of expressions, gazes, springs, constraints and
// MToon; called by check-vrm.
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { Euler, MathUtils } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { VRMLoaderPlugin } from '@pixiv/three-vrm';

globalThis.self = globalThis;

// Of weights, and of degrees.
const farthest = { weight: 1e-5, degrees: 1e-3, number: 1e-6, color: 1e-5 };

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

// What a colour is encoded as: three-vrm takes a power for the codes of version 0, here it is the standard's
// curve.
const power = x => x ** (1 / 2.2);
const sRGB = x => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

const totals = { files: 0, weights: 0, gazes: 0, springs: 0, constraints: 0, materials: 0 };
const worst = { weight: 0, degrees: 0, number: 0, color: 0 };
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
    const list = (kind, found, ours, what) => ours.forEach((number, at) => compare(kind, found[at], number, what));
    const same = (found, ours, what) => {
        if (found !== ours) fail(`${what}: three-vrm ${found}, here ${ours}`);
    };

    const joints = [...vrm.springBoneManager.joints];
    same(joints.length, expected.springs.length, 'joints of springs');
    for (const { node, end, center, numbers, gravityDir, colliders } of expected.springs) {
        const joint = joints.find(joint => joint.bone.name === node);
        if (!joint) fail(`three-vrm has no spring at ${node}`);
        const { hitRadius, stiffness, gravityPower, dragForce, gravityDir: dir } = joint.settings;
        same(joint.child?.name ?? null, end, `end of ${node}`);
        same(joint.center?.name ?? null, center, `center of ${node}`);
        list('number', [hitRadius, stiffness, gravityPower, dragForce], numbers, `spring ${node}`);
        list('number', dir.toArray(), gravityDir, `gravity of ${node}`);
        const theirs = joint.colliderGroups.flatMap(group => group.colliders);
        same(theirs.length, colliders.length, `colliders of ${node}`);
        colliders.forEach((ours, at) => {
            const { shape, parent } = theirs[at];
            same(parent.name, ours.node, `collider ${at} of ${node}`);
            list('number', shape.offset.toArray(), ours.offset, `collider ${at} of ${node}`);
            same(shape.tail !== undefined, ours.tail !== undefined, `form of collider ${at} of ${node}`);
            same(shape.normal !== undefined, ours.normal !== undefined, `form of collider ${at} of ${node}`);
            if (ours.normal) {
                list('number', shape.normal.toArray(), ours.normal, `plane ${at} of ${node}`);
                return;
            }
            compare('number', shape.radius, ours.radius, `radius of collider ${at} of ${node}`);
            same(shape.inside, ours.inside, `side of collider ${at} of ${node}`);
            if (ours.tail) list('number', shape.tail.toArray(), ours.tail, `tail of collider ${at} of ${node}`);
        });
        totals.springs += 1;
    }
    const constraints = [...(vrm.nodeConstraintManager?.constraints ?? [])];
    same(constraints.length, expected.constraints.length, 'constraints');
    for (const { node, source, weight, kind, axis } of expected.constraints) {
        const theirs = constraints.find(constraint => constraint.destination.name === node);
        if (!theirs) fail(`three-vrm has no constraint at ${node}`);
        same(theirs.source.name, source, `source of ${node}`);
        compare('number', theirs.weight, weight, `constraint ${node}`);
        same(theirs.constructor.name.replace('_', '').toLowerCase().includes(kind), true, `kind of constraint ${node}`);
        if (axis) {
            const named = { X: [1, 0, 0], Y: [0, 1, 0], Z: [0, 0, 1] };
            const name = theirs.rollAxis ?? theirs.aimAxis;
            const sign = name.startsWith('Negative') ? -1 : 1;
            list('number', named[name.slice(-1)].map(x => sign * x), axis, `axis of ${node}`);
        }
        totals.constraints += 1;
    }
    const material = [face.material].flat().find(material => !material.isOutline);
    const encoded = vrm.meta.metaVersion === '0' ? [power, sRGB] : [x => x, x => x];
    for (const [theirs, ours, what] of [
        [material.color, expected.toon.base, 'colour'],
        [material.shadeColorFactor, expected.toon.shade, 'colour in the shade'],
        [material.outlineColorFactor, expected.toon.outline, 'colour of the outline'],
    ]) {
        list('color', theirs.toArray().map(encoded[0]), ours.map(encoded[1]), what);
    }
    const { shadingShiftFactor, shadingToonyFactor, outlineWidthFactor } = material;
    list('number', [shadingShiftFactor, shadingToonyFactor, outlineWidthFactor], expected.toon.numbers, 'MToon');
    totals.materials += 1;
    totals.files += 1;
}
console.log(`three-vrm agrees on ${totals.files} files, ${totals.weights} weights (within ${worst.weight}), ` +
    `${totals.gazes} gazes (within ${worst.degrees} degrees), ${totals.springs} joints of springs and ` +
    `${totals.constraints} constraints (within ${worst.number}), ${totals.materials} materials (colours within ${worst.color})`);
