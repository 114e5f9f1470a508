// Serves folders to this computer alone, for tests: the first that has a file gives it.
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";

const TYPES = {
  ".html": "text/html; charset=utf-8",
  ".js": "text/javascript",
  ".mjs": "text/javascript",
  ".wasm": "application/wasm",
  ".zip": "application/zip",
  ".glb": "model/gltf-binary",
};

/** Starts a server of these folders and of `pages`, texts by address. Returns its address. */
export async function serve(folders, pages = {}) {
  const server = createServer(async (request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname)).replace(/^\/$/, "/index.html");
    const send = (bytes) => {
      response.setHeader("content-type", TYPES[extname(path)] ?? "application/octet-stream");
      response.setHeader("cache-control", "no-store");
      response.setHeader("content-length", bytes.length);
      response.end(bytes);
    };
    if (pages[path] !== undefined) return send(Buffer.from(pages[path]));
    for (const folder of folders) {
      try {
        return send(await readFile(join(folder, path)));
      } catch {
        continue;
      }
    }
    response.statusCode = 404;
    response.end();
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
