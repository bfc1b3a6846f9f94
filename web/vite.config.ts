// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vite";

// The page is served by the station itself: relative addresses, nothing from elsewhere.
export default defineConfig({
  base: "./",
  build: {
    target: "es2022", outDir: "dist", emptyOutDir: true, sourcemap: false, assetsInlineLimit: 0, reportCompressedSize: true, chunkSizeWarningLimit: 700,
    rollupOptions: { input: ["index.html", "recording.html", "people.html", "patient.html"] }, // the cockpit, the pages of recordings and of patients, the patient's screen
  },
  worker: { format: "es" },
  server: {
    // `npx vite` serves the page during development; the station runs beside it.
    proxy: {
      "/stream": { target: "ws://127.0.0.1:8480", ws: true },
      "/geometry": "http://127.0.0.1:8480",
      "/recordings": "http://127.0.0.1:8480",
      "/mesh": "http://127.0.0.1:8480",
      "/stop": "http://127.0.0.1:8480",
      "^/people($|/)": "http://127.0.0.1:8480",
    },
  },
});
