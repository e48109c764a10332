// SPDX-License-Identifier: Apache-2.0
// A server of files alone, as a site of static files has it, on the loopback interface.
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";

const kTypes = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
};

/** Serves `folder`, and below files/ those that `named` has by name. `asked` lists the requests, "GET /page.js"; `stop` ends it. */
export async function serve(test, folder, named = {}) {
  const asked = [];
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname)),
      file = path.startsWith("/files/")
        ? named[path.slice("/files/".length)]
        : join(folder, path.endsWith("/") ? `${path}index.html` : path);
    asked.push(`${request.method} ${path}`);
    try {
      const bytes = readFileSync(file);
      response
        .writeHead(200, { "Content-Type": kTypes[extname(file)] ?? "application/octet-stream" })
        .end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  const stop = () => {
    server.closeAllConnections();
    server.close();
  };
  test.after(stop);
  await new Promise(resolve => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, asked, stop };
}
