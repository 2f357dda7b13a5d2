// Bundles the viewer into dist/viewer.js, which the Rust side takes in.
import { build } from "esbuild";

await build({
  entryPoints: ["src/main.js"],
  outfile: "dist/viewer.js",
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2020",
  charset: "ascii",
  legalComments: "none",
});
