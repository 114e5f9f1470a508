// Validates GLB files and parses them with three.js; called by check-glb.
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import validator from 'gltf-validator';
import { AnimationMixer, Texture, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// Node has no decoder of pictures; that they are PNG or JPEG is what the validator checks.
globalThis.self = globalThis;
const noPictures = parser => {
    parser.loadTexture = async () => new Texture();
    return { name: 'no pictures' };
};

// The scenes of random_glb hold shear, matrices without an inverse and pictures of nothing but a signature on purpose.
const onPurpose = new Set(['NODE_MATRIX_NON_TRS', 'IMAGE_DATA_INVALID', 'IMAGE_UNEXPECTED_EOS']);

async function threeReads(bytes) {
    const loader = new GLTFLoader().register(noPictures);
    const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
    const found = { meshes: 0, skinned: 0, shapes: 0, clips: gltf.animations.length, vertices: 0 };
    if (!gltf.scene) return found;
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
            for (let vertex = 0; vertex < count; vertex += Math.ceil(count / 50)) {
                object.getVertexPosition(vertex, at);
                if (![at.x, at.y, at.z].every(Number.isFinite)) throw new Error(`vertex ${vertex} of ${object.name}`);
                found.vertices += 1;
            }
        });
    }
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
        const found = await threeReads(bytes);
        const counts = Object.entries(found).map(([what, count]) => `${count} ${what}`).join(', ');
        console.log(`${name}: ${errors.length} errors, ${issues.numWarnings} warnings; three.js: ${counts}`);
    } catch (error) {
        failures += 1;
        console.error(`${name}: three.js: ${error.message}`);
    }
}
if (process.argv.length < 3) failures += 1;
process.exit(failures === 0 ? 0 : 1);
