// Where the archive comes from: it may be within the page, beside it on the server, or still to be chosen.
import "uplot/dist/uPlot.min.css";
import "./ui/theme.css";
import { App } from "./app";
import { bytesOfBase64 } from "./archive/base64";
import { fill, h, sentenceOf } from "./ui/dom";
import { useTheme } from "./ui/theme";

/** Files of an archive that stand in the page as base64, each in a block of data that no browser runs. */
function embedded(): { files: Map<string, Uint8Array>; root: string; name: string } | null {
  const blocks = document.querySelectorAll<HTMLScriptElement>("script[data-lumenline-file]");
  if (blocks.length === 0) return null;
  const files = new Map<string, Uint8Array>();
  let [root, name] = ["", ""];
  for (const block of blocks) {
    const path = block.dataset.lumenlineFile!;
    files.set(path, bytesOfBase64(block.textContent!));
    root ||= path;
    name ||= block.dataset.lumenlineName ?? path;
    block.remove();
  }
  return { files, root, name };
}

async function begin(): Promise<void> {
  useTheme();
  const app = new App(document.getElementById("app")!);
  const inside = embedded();
  if (inside) return app.open({ kind: "embedded", ...inside });
  const served = await app.client.call("served", null);
  return served ? app.open(served) : app.start();
}

begin().catch((error: unknown) => {
  // Without a worker, say, or from a page that was damaged on its way.
  fill(document.getElementById("app")!, h("main", { class: "message error", role: "alert" },
    h("h1", {}, "This cannot be shown"), h("p", {}, sentenceOf(error))));
});
