// Validates GLB files and parses them with three.js; called by check-glb.
import { existsSync, readFileSync } from 'node:fs';
import { basename } from 'node:path';
import validator from 'gltf-validator';
import { AnimationMixer, Texture, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// Node has no decoder of pictures; that they are PNG or JPEG is what the validator checks.
globalThis.self = globalThis;
const noPictures = parser => {
    // The second one is called for pictures of extensions.
    parser.loadTexture = parser.loadTextureImage = async () => new Texture();
    return { name: 'no pictures' };
};

// The scenes of random_glb hold shear on purpose; it is written as it is.
const onPurpose = new Set(['NODE_MATRIX_NON_TRS']);

// Mean positions of parts in poses as the program computes them, where export_glb wrote them beside the file;
// and how far three.js may be from them, in units of the rig.
const farthest = 1e-4;
function expectedOf(path) {
    const file = path.replace(/glb$/, 'tsv');
    const lines = existsSync(file) ? readFileSync(file, 'utf8').trim().split('\n') : [];
    return new Map(lines.map(line => {
        const [pose, part, ...mean] = line.split('\t');
        return [`${pose}\t${part}`, mean.map(Number)];
    }));
}

// All vertices where mixtures take them at 1, which the targets of their names have to do alone, where
// export_glb wrote them beside the file; and how far three.js may be from them.
const farthestTarget = 1e-5;
function compareTargets(path, scene) {
    const file = path.replace(/glb$/, 'targets.tsv');
    if (!existsSync(file)) return;
    const buffer = readFileSync(path.replace(/glb$/, 'targets.f32'));
    const numbers = new Float32Array(buffer.buffer, buffer.byteOffset, buffer.byteLength / 4);
    const at = new Vector3();
    let [worst, moving, vertices] = [0, 0, 0];
    for (const line of readFileSync(file, 'utf8').trim().split('\n')) {
        const [name, part, first] = line.split('\t');
        const object = scene.getObjectByName(part);
        const target = object.morphTargetDictionary?.[name];
        object.morphTargetInfluences?.fill(0);
        if (target !== undefined) object.morphTargetInfluences[target] = 1;
        moving += target !== undefined ? 1 : 0;
        for (let vertex = 0; vertex < object.geometry.attributes.position.count; vertex += 1) {
            object.getVertexPosition(vertex, at);
            at.toArray().forEach((x, i) => {
                const off = Math.abs(x - numbers[Number(first) + 3 * vertex + i]);
                if (!(off <= farthestTarget)) throw new Error(`${name}, vertex ${vertex} of ${part} is off by ${off}`);
                worst = Math.max(worst, off);
            });
            vertices += 1;
        }
        object.morphTargetInfluences?.fill(0);
    }
    console.log(`three.js agrees on ${moving} targets of mixtures, ${vertices} vertices, to within ${worst}`);
}

async function threeReads(path, bytes) {
    const expected = expectedOf(path);
    const loader = new GLTFLoader().register(noPictures);
    const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
    const found = { meshes: 0, skinned: 0, shapes: 0, clips: gltf.animations.length, vertices: 0 };
    if (!gltf.scene) return found;
    let compared = 0;
    let worst = 0;
    const mixer = new AnimationMixer(gltf.scene);
    for (const clip of [null, ...gltf.animations]) {
        mixer.stopAllAction();
        if (clip) mixer.clipAction(clip).play();
        mixer.setTime(clip ? clip.duration / 2 : 0);
        gltf.scene.updateMatrixWorld(true);
        gltf.scene.traverse(object => {
            if (!object.isMesh) return;
            if (!clip) {
                found.meshes += 1;
                found.skinned += object.isSkinnedMesh ? 1 : 0;
                found.shapes += object.morphTargetInfluences?.length ?? 0;
            }
            const at = new Vector3();
            const count = object.geometry.attributes.position.count;
            const mean = expected.get(`${clip?.name}\t${object.name}`);
            const sum = new Vector3();
            for (let vertex = 0; vertex < count; vertex += mean ? 1 : Math.ceil(count / 50)) {
                object.getVertexPosition(vertex, at);
                if (![at.x, at.y, at.z].every(Number.isFinite)) throw new Error(`vertex ${vertex} of ${object.name}`);
                sum.add(at);
                found.vertices += 1;
            }
            if (!mean) return;
            compared += 1;
            sum.divideScalar(count).toArray().forEach((x, i) => {
                const off = Math.abs(x - mean[i]);
                if (!(off <= farthest)) throw new Error(`${clip.name}, ${object.name}: expected ${mean}, found ${sum.toArray()}`);
                worst = Math.max(worst, off);
            });
        });
    }
    if (compared < expected.size) throw new Error(`${expected.size} parts in poses expected, ${compared} found`);
    mixer.stopAllAction();
    gltf.scene.updateMatrixWorld(true);
    compareTargets(path, gltf.scene);
    if (compared > 0) console.log(`three.js agrees on ${compared} parts in poses to within ${worst}`);
    return found;
}

let failures = 0;
for (const path of process.argv.slice(2)) {
    const bytes = new Uint8Array(readFileSync(path));
    const name = basename(path);
    const { issues } = await validator.validateBytes(bytes, { maxIssues: 0 });
    const allowed = name.startsWith('random-') ? onPurpose : new Set();
    const errors = issues.messages.filter(message => message.severity === 0 && !allowed.has(message.code));
    errors.slice(0, 10).forEach(error => console.error(`${name}: ${error.code} ${error.pointer}: ${error.message}`));
    failures += errors.length;
    try {
        const found = await threeReads(path, bytes);
        const counts = Object.entries(found).map(([what, count]) => `${count} ${what}`).join(', ');
        console.log(`${name}: ${errors.length} errors, ${issues.numWarnings} warnings; three.js: ${counts}`);
    } catch (error) {
        failures += 1;
        console.error(`${name}: three.js: ${error.message}`);
    }
}
if (process.argv.length < 3) failures += 1;
process.exit(failures === 0 ? 0 : 1);
