// Prints what the files of a folder weigh, as they are and packed by brotli at its usual care (9 of 11), and
// fails where the library or the face is too large: web-sizes.mjs FOLDER
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { brotliCompressSync, constants } from "node:zlib";

const LIMITS = { "avatar_web_bg.wasm": 3.5e6, "marsienne.zip": 6e6 };
const folder = process.argv[2];
let isTooLarge = false;
for (const name of readdirSync(folder).sort()) {
  const bytes = readFileSync(join(folder, name));
  const params = { [constants.BROTLI_PARAM_QUALITY]: 9, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length };
  const packed = Math.min(brotliCompressSync(bytes, { params }).length, bytes.length);
  const limit = LIMITS[name];
  const verdict = limit === undefined ? "" : packed <= limit ? `  of at most ${limit}` : `  EXPECTED at most ${limit}`;
  isTooLarge ||= limit !== undefined && packed > limit;
  console.log(`${String(bytes.length).padStart(10)} ${String(packed).padStart(10)} packed  ${name}${verdict}`);
}
process.exit(isTooLarge ? 1 : 0);
