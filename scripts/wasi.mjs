// Runs a test that was built for wasm32-wasip1: node wasi.mjs TEST.wasm [OPTIONS]. The runner of scripts/hosts.
import { readFile } from "node:fs/promises";
import { WASI } from "node:wasi";

const [, , file, ...options] = process.argv;
const wasi = new WASI({ version: "preview1", args: [file, ...options], env: process.env, preopens: { "/": "/" }, returnOnExit: true });
const instance = await WebAssembly.instantiate(await WebAssembly.compile(await readFile(file)), wasi.getImportObject());
process.exit(wasi.start(instance));
