// The server from outside: what it gives, what it refuses, and that it is of this machine alone.
import assert from "node:assert/strict";
import { readFileSync, symlinkSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { networkInterfaces } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { gunzipSync } from "node:zlib";
import { archives, serve } from "./support.mjs";

let server;
before(async () => {
  writeFileSync(join(archives, "secret.hdf"), "secret");
  try {
    symlinkSync(join(archives, "secret.hdf"), join(archives, "good/models/link.hdf"));
  } catch (error) {
    if (error.code !== "EEXIST") throw error;
  }
  server = await serve(join(archives, "good"), "--port", "0");
});
after(() => server?.stop());

/** One request as it is written here: clients would tidy the path up. */
function raw(path, { method = "GET", host = `127.0.0.1:${server.port}`, headers = [], version = "1.1" } = {}) {
  return new Promise((done, failed) => {
    const socket = connect(server.port, "127.0.0.1");
    const parts = [];
    socket.on("data", (data) => parts.push(data));
    socket.on("error", failed);
    socket.on("close", () => {
      const all = Buffer.concat(parts);
      const end = all.indexOf("\r\n\r\n");
      const [first, ...rest] = all.toString("latin1", 0, end).split("\r\n");
      const fields = Object.fromEntries(rest.map((line) => [line.slice(0, line.indexOf(":")).toLowerCase(), line.slice(line.indexOf(":") + 2)]));
      done({ status: Number(first.split(" ")[1]), headers: fields, body: all.subarray(end + 4) });
    });
    const lines = [`${method} ${path} HTTP/${version}`, ...(host === null ? [] : [`Host: ${host}`]), "Connection: close", ...headers];
    socket.write(lines.join("\r\n") + "\r\n\r\n");
  });
}

const file = () => readFileSync(join(archives, "good/cohort.h5"));

test("the page, what the archive is, and its files are given", async () => {
  const page = await raw("/", { headers: ["Accept-Encoding: gzip"] });
  assert.equal(page.status, 200);
  assert.equal(page.headers["content-encoding"], "gzip");
  const plain = await raw("/");
  assert.equal(plain.headers["content-encoding"], undefined);
  assert.match(plain.body.toString("utf8", 0, 100), /<!doctype html>/);
  const packed = await raw("/hdf5.wasm", { headers: ["Accept-Encoding: gzip, br"] });
  assert.equal(packed.headers["content-encoding"], "gzip");
  assert.equal(packed.headers["content-type"], "application/wasm");
  const library = await raw("/hdf5.wasm");
  assert.equal(library.headers["content-encoding"], undefined);
  assert.ok(library.body.equals(gunzipSync(packed.body)) && WebAssembly.validate(library.body));
  for (const path of ["/", "/hdf5.wasm"]) assert.equal((await raw(path, { headers: ["Range: bytes=0-9"] })).status, 416, path);
  assert.deepEqual(JSON.parse((await raw("/archive.json")).body), { root: "cohort.h5", name: "good" });
  assert.ok((await raw("/archive/cohort.h5")).body.equals(file()));
  const model = await raw("/archive/models/torus.hdf");
  assert.ok(model.body.equals(readFileSync(join(archives, "good/models/torus.hdf"))));
});

test("ranges are given as asked for, and refused where they do not fit", async () => {
  const whole = file();
  const range = (text) => raw("/archive/cohort.h5", { headers: [`Range: bytes=${text}`] });
  for (const [text, first, end] of [["0-0", 0, 1], ["5-99", 5, 100], [`${whole.length - 7}-`, whole.length - 7, whole.length], ["-9", whole.length - 9, whole.length]]) {
    const part = await range(text);
    assert.equal(part.status, 206, text);
    assert.ok(part.body.equals(whole.subarray(first, end)), text);
  }
  for (const text of [`${whole.length}-`, `0-${whole.length}`, "0-1,5-6", "9-5", `-${whole.length + 1}`, "-0", "x-y", "99999999999999999999-"])
    assert.equal((await range(text)).status, 416, text);
  const head = await raw("/archive/cohort.h5", { method: "HEAD" });
  assert.equal(head.status, 200);
  assert.equal(Number(head.headers["content-length"]), whole.length);
  assert.equal(head.body.length, 0);
  assert.match(head.headers.etag, /^"/);
});

test("nothing outside of the archive is given", async () => {
  for (const path of [
    "/archive/../secret.hdf", "/archive/models/../../secret.hdf", "/archive/models/%2e%2e/%2e%2e/secret.hdf",
    "/archive/models/..%2f..%2fsecret.hdf", "/archive//etc/passwd", "/archive/models/link.hdf", "/archive/%2fetc%2fpasswd",
    "/archive/models/torus.hdf%00.hdf", "/archive/", "/archive", "/archive/models/", "/cohort.h5", "/../../etc/passwd",
    "/archive/shards.tsv", "/archive/models/torus.hdf/", "//archive/cohort.h5", "/archive/models/%", "/archive/models/%zz.hdf",
  ]) {
    const answer = await raw(path);
    assert.equal(answer.status, 404, path);
    assert.ok(!answer.body.includes("secret") && !answer.body.includes("root:"), path);
  }
});

test("nothing can be written", async () => {
  for (const method of ["POST", "PUT", "DELETE", "PATCH", "OPTIONS"])
    assert.equal((await raw("/archive/cohort.h5", { method, headers: ["Content-Length: 0"] })).status, 405, method);
});

test("requests in the name of another host are refused", async () => {
  for (const host of ["evil.example", `evil.example:${server.port}`, "127.0.0.1.evil.example", "", null, "localhost.evil.example", "192.168.0.1"])
    assert.ok([400, 403].includes((await raw("/archive/cohort.h5", { host })).status), String(host));
  for (const host of ["localhost", `localhost:${server.port}`, "127.0.0.1", "[::1]:80"])
    assert.equal((await raw("/archive.json", { host })).status, 200, host);
});

test("every answer has the strict headers", async () => {
  for (const path of ["/", "/archive.json", "/archive/cohort.h5", "/nothing"]) {
    const { headers } = await raw(path, { headers: ["Accept-Encoding: gzip, br"] });
    const policy = headers["content-security-policy"] ?? "";
    assert.match(policy, /^default-src 'none'; script-src (?:'sha256-[^ ]+' ){2}'wasm-unsafe-eval';/, path);
    assert.match(policy, /frame-ancestors 'none'/);
    assert.doesNotMatch(policy, /unsafe-inline|'unsafe-eval'|\*|https?:/);
    assert.equal(headers["x-content-type-options"], "nosniff");
    assert.equal(headers["referrer-policy"], "no-referrer");
    assert.equal(headers["cross-origin-resource-policy"], "same-origin");
    assert.equal(headers["access-control-allow-origin"], undefined);
  }
});

test("the server listens on loopback only", async () => {
  const others = Object.values(networkInterfaces()).flat().filter((at) => at && !at.internal && at.family === "IPv4");
  for (const { address } of others) {
    const reached = await new Promise((done) => {
      const socket = connect({ port: server.port, host: address, timeout: 3000 });
      socket.on("connect", () => (socket.destroy(), done(true)));
      socket.on("error", () => done(false));
      socket.on("timeout", () => (socket.destroy(), done(false)));
    });
    assert.equal(reached, false, address);
  }
});

test("a port in use and an archive that is none are said in one sentence", async () => {
  const attempt = async (...args) => {
    try {
      const second = await serve(...args);
      await second.stop();
      return null;
    } catch (error) {
      return error;
    }
  };
  const taken = await attempt(join(archives, "good"), "--port", String(server.port));
  assert.match(taken?.message ?? "", /port \d+ .* in use/);
  const nothing = await attempt(join(archives, "nowhere"));
  assert.match(nothing?.message ?? "", /there is no archive/);
  assert.equal(nothing?.code, 2);
  const damaged = await attempt(join(archives, "no-index"));
  assert.equal(damaged?.code, 1);
  for (const error of [taken, nothing, damaged]) assert.equal(error.message.trim().split("\n").length, 1, error.message);
});

test("an interrupt ends the server with status 0", async () => {
  const other = await serve(join(archives, "good/models/torus.hdf"), "--port", "0");
  const about = await (await fetch(`${other.address}archive.json`)).json();
  assert.deepEqual(about, { root: "torus.hdf", name: "torus.hdf" });
  assert.equal(await other.stop(), 0);
});
