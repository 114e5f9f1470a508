// How much of the processors others take while something is timed: on a busy machine times tell nothing.
import { readFileSync, readdirSync } from "node:fs";
import { cpus } from "node:os";

/** Ticks a second of Linux's clock of processor time. */
const TICKS = 100;

/** What has been spent until now; `others(before)` is the share of all processors that others had since. */
export function spent() {
  const now = { secs: performance.now() / 1000, all: ofAll(), own: ofOwn() };
  const others = (before) => {
    const own = now.own - before.own;
    return Math.max(0, (now.all - before.all - own) / ((now.secs - before.secs) * cpus().length));
  };
  return { ...now, others };
}

/** Processor seconds of everything, whatever ran it. */
function ofAll() {
  const [user, nice, system, , , interrupts, soft, stolen] = readFileSync("/proc/stat", "utf8").split("\n")[0].trim().split(/\s+/).slice(1).map(Number);
  return (user + nice + system + interrupts + soft + stolen) / TICKS;
}

/** Processor seconds of this program and of what it has started. */
function ofOwn() {
  const processes = new Map();
  for (const id of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      // Behind the name, which may hold anything.
      const fields = readFileSync(`/proc/${id}/stat`, "utf8").split(") ").at(-1).split(" ");
      processes.set(Number(id), { parent: Number(fields[1]), secs: (Number(fields[11]) + Number(fields[12])) / TICKS });
    } catch {
      // It has ended meanwhile.
    }
  }
  const isOwn = (id) => id === process.pid || (processes.has(id) && isOwn(processes.get(id).parent));
  return [...processes].filter(([id]) => isOwn(id)).reduce((sum, [, { secs }]) => sum + secs, 0);
}
