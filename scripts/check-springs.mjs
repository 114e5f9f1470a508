// Swings the chains of joint-springs' example `witness` by three-vrm and compares; called by check-springs.
import { readFileSync } from 'node:fs';
import { Object3D, Quaternion, Scene, Vector3 } from 'three';
import {
    VRMSpringBoneCollider, VRMSpringBoneColliderShapeCapsule, VRMSpringBoneColliderShapeSphere, VRMSpringBoneJoint,
    VRMSpringBoneManager,
} from '@pixiv/three-vrm';

const JOINTS = 5;
const LENGTH = JOINTS * Math.hypot(0.06, 0.01);
const ALLOWED = 0.02;
// The one chain, the loosest, that is not held to three-vrm as it is.
const LOOSEST = 0.15;
const ALLOWED_BETWEEN_RATES = 0.001;

// three-vrm measures a joint's length anew at each step, from where the joint is now to where the next one
// was at the step before; the standard has one length. It is compared as it is and with one length.
const measured = VRMSpringBoneJoint.prototype._calcWorldSpaceBoneLength;
function constant() {
    this._worldSpaceBoneLength = LENGTH / JOINTS;
}

function chain({ stiffness, drag, gravity, hits }) {
    const scene = new Scene();
    const head = new Object3D();
    scene.add(head);
    const bones = [head];
    for (let joint = 1; joint <= JOINTS + 1; joint += 1) {
        const bone = new Object3D();
        bone.position.set(...(joint === 1 ? [0, 0, -0.11] : [0, -0.06, -0.01]));
        bones.at(-1).add(bone);
        bones.push(bone);
    }
    const shapes = [
        new VRMSpringBoneColliderShapeSphere({ offset: new Vector3(0, 0.02, 0), radius: 0.09 }),
        new VRMSpringBoneColliderShapeCapsule({
            offset: new Vector3(-0.1, -0.25, 0), tail: new Vector3(0.1, -0.25, 0), radius: 0.06,
        }),
    ];
    const colliders = hits ? shapes.map(shape => {
        const collider = new VRMSpringBoneCollider(shape);
        head.add(collider);
        return collider;
    }) : [];
    const power = Math.hypot(...gravity);
    const settings = {
        hitRadius: 0.01, stiffness, dragForce: drag, gravityPower: power,
        gravityDir: new Vector3(...gravity).divideScalar(power || 1),
    };
    const manager = new VRMSpringBoneManager();
    for (let joint = 1; joint <= JOINTS; joint += 1) {
        manager.addJoint(new VRMSpringBoneJoint(bones[joint], bones[joint + 1], settings, [{ colliders }]));
    }
    return { scene, head, bones, manager };
}

const read = rate => JSON.parse(readFileSync(`${process.argv[2]}/${rate}.json`, 'utf8'));
const cases = { 24: read(24), 60: read(60), 144: read(144), 240: read(240), 960: read(960) };
const distance = (a, b) => Math.hypot(...a.map((x, at) => x - b[at]));
let failed = false;

// Swings a chain by three-vrm, with a step for each frame; `look` gets each frame, its number, the tails and
// the head.
function swing(one, rate, look) {
    const { scene, head, bones, manager } = chain(one);
    const place = ({ turn, place }) => {
        head.quaternion.copy(new Quaternion(...turn));
        head.position.set(...place);
        scene.updateMatrixWorld(true);
    };
    place(one.frames[0]);
    manager.setInitState();
    one.frames.forEach((frame, at) => {
        place(frame);
        if (at > 0) manager.update(1 / rate);
        scene.updateMatrixWorld(true);
        const tails = bones.slice(2).map(bone => new Vector3().setFromMatrixPosition(bone.matrixWorld).toArray());
        look(frame, at, tails, head);
    });
}

// How far tails are from three-vrm's at most, and how far the end is from that of a stiff chain.
function compare(one) {
    let [worst, most] = [0, 0];
    const rest = new Vector3();
    swing(one, 60, (frame, _, tails, head) => {
        tails.forEach((theirs, at) => {
            worst = Math.max(worst, distance(theirs, frame.tails.slice(3 * at, 3 * at + 3)));
        });
        rest.set(0, -0.06 * JOINTS, -0.11 - 0.01 * JOINTS).applyMatrix4(head.matrixWorld);
        most = Math.max(most, distance(rest.toArray(), frame.tails.slice(-3)));
    });
    return { worst, swing: most };
}

// The ends of three-vrm's chain in each frame, as it is or with one length.
function ends(one, rate, length) {
    VRMSpringBoneJoint.prototype._calcWorldSpaceBoneLength = length;
    const all = [];
    swing(one, rate, (_, at, tails) => { all[at] = tails.at(-1); });
    return all;
}

console.log('| stiffness | drag | gravity | colliders | swing | from three-vrm, one length | from three-vrm, lengths measured | 24 Hz from 60 Hz | 144 Hz from 60 Hz |');
console.log('|---|---|---|---|---|---|---|---|---|');
cases[60].forEach((one, number) => {
    VRMSpringBoneJoint.prototype._calcWorldSpaceBoneLength = measured;
    const asItIs = compare(one).worst;
    VRMSpringBoneJoint.prototype._calcWorldSpaceBoneLength = constant;
    const { worst, swing } = compare(one);
    const between = rate => {
        // Moments that both rates have: twelve a second.
        let most = 0;
        for (let moment = 0; moment <= 96; moment += 1) {
            const [a, b] = [cases[60][number].frames[5 * moment], cases[rate][number].frames[(rate / 12) * moment]];
            most = Math.max(most, distance(a.tails.slice(-3), b.tails.slice(-3)));
        }
        return most;
    };
    const share = meters => `${(100 * meters / LENGTH).toFixed(2)} %`;
    console.log(`| ${one.stiffness} | ${one.drag} | ${one.gravity} | ${one.hits ? 'yes' : 'no'} | ${share(swing)} | ` +
        `${share(worst)} | ${share(asItIs)} | ${share(between(24))} | ${share(between(144))} |`);
    // A chain that does not swing proves nothing.
    failed ||= !(worst < ALLOWED * LENGTH) || !(swing > 0.05 * LENGTH);
    failed ||= one.stiffness !== LOOSEST && !(asItIs < ALLOWED * LENGTH);
    failed ||= !(between(144) < ALLOWED_BETWEEN_RATES * LENGTH);
});

// How much of it comes of the lengths: three-vrm beside itself with one length, by how long its steps are.
console.log('\n| the loosest chain by three-vrm alone, steps a second | from that with one length | from its own at 60 steps |');
console.log('|---|---|---|');
const loosest = cases[60].findIndex(one => one.stiffness === LOOSEST);
const farthest = (a, b) => Math.max(...a.map((end, at) => distance(end, b[at])));
// Moments that all rates have: twelve a second.
const moments = (all, rate) => all.filter((_, at) => at % (rate / 12) === 0);
const usual = moments(ends(cases[60][loosest], 60, measured), 60);
const byLengths = [24, 60, 240, 960].map(rate => {
    const asItIs = ends(cases[rate][loosest], rate, measured);
    const most = farthest(asItIs, ends(cases[rate][loosest], rate, constant)) / LENGTH;
    const own = farthest(moments(asItIs, rate), usual) / LENGTH;
    console.log(`| ${rate} | ${(100 * most).toFixed(2)} % | ${(100 * own).toFixed(2)} % |`);
    return most;
});
// What lengths do vanishes with the steps.
failed ||= !(byLengths.at(-1) < ALLOWED);
if (failed) {
    console.error(`a chain is more than ${100 * ALLOWED} % of its length from three-vrm's, does not swing, or is ` +
        `more than ${100 * ALLOWED_BETWEEN_RATES} % elsewhere at 144 Hz`);
    process.exit(1);
}
