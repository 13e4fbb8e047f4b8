// Nothing is open yet: an archive can be dropped or chosen, as a folder, as one packed file, or as a model file.
import type { Opened } from "../archive/protocol";
import { fill, h } from "./dom";

/** The index among the files of a folder, or the one file there is. */
function arrange(found: Map<string, Blob>): Opened | string {
  const index = [...found.keys()].filter((path) => path.split("/").at(-1) === "cohort.h5").sort((a, b) => a.length - b.length)[0];
  if (index !== undefined) {
    const folder = index.slice(0, -"cohort.h5".length);
    const files = new Map<string, Blob>();
    for (const [path, file] of found) if (path.startsWith(folder)) files.set(path.slice(folder.length), file);
    return { kind: "local", files, root: "cohort.h5", name: folder.replace(/\/$/, "").split("/").at(-1) || "cohort.h5" };
  }
  const single = [...found].filter(([path]) => /\.(h5|hdf5?)$/i.test(path));
  if (single.length === 1) {
    const [path, file] = single[0]!;
    const name = path.split("/").at(-1)!;
    return { kind: "local", files: new Map([[name, file]]), root: name, name };
  }
  if (single.length > 1) return "There is no cohort.h5 among these files: open the archive's folder, or one file.";
  return "There is no HDF5 file (.h5, .hdf) here.";
}

async function walk(entry: FileSystemEntry, path: string, found: Map<string, Blob>): Promise<void> {
  if (entry.isFile) {
    found.set(path + entry.name, await new Promise<File>((done, failed) => (entry as FileSystemFileEntry).file(done, failed)));
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  for (;;) {
    const part = await new Promise<FileSystemEntry[]>((done, failed) => reader.readEntries(done, failed));
    if (part.length === 0) return;
    for (const child of part) await walk(child, `${path}${entry.name}/`, found);
  }
}

export class StartView {
  readonly root: HTMLElement;
  private readonly problem = h("p", { class: "problem", role: "alert" });

  constructor(private readonly open: (opened: Opened) => void) {
    const file = h("input", { type: "file", accept: ".h5,.hdf,.hdf5", id: "open-file", on: { change: () => this.chosen(file) } });
    const folder = h("input", { type: "file", webkitdirectory: true, id: "open-folder", on: { change: () => this.chosen(folder) } });
    this.root = h("main", {
      class: "start",
    },
      h("h1", {}, "Open an archive"),
      h("p", {}, "Drop an archive here: the folder that holds cohort.h5, a packed archive (.h5), or one model file (.hdf). It is read where it lies; nothing is sent anywhere."),
      h("div", { class: "openers" },
        h("label", { class: "button", for: "open-folder" }, "Choose a folder", folder),
        h("label", { class: "button", for: "open-file" }, "Choose a file", file)),
      this.problem);
    // Wherever on the page: beside the box, browsers would leave the page for the file.
    document.addEventListener("dragover", this.dragged);
    document.addEventListener("dragleave", this.dragEnds);
    document.addEventListener("drop", this.drop);
  }

  dispose(): void {
    document.removeEventListener("dragover", this.dragged);
    document.removeEventListener("dragleave", this.dragEnds);
    document.removeEventListener("drop", this.drop);
  }

  private readonly dragged = (event: DragEvent): void => {
    event.preventDefault();
    this.root.classList.add("over");
  };
  private readonly dragEnds = (): void => this.root.classList.remove("over");
  private readonly drop = (event: DragEvent): void => void this.dropped(event);

  private use(found: Map<string, Blob>): void {
    const opened = arrange(found);
    if (typeof opened === "string") fill(this.problem, opened);
    else this.open(opened);
  }

  private chosen(input: HTMLInputElement): void {
    this.use(new Map([...(input.files ?? [])].map((file) => [file.webkitRelativePath || file.name, file])));
  }

  private async dropped(event: DragEvent): Promise<void> {
    event.preventDefault();
    this.root.classList.remove("over");
    const items = [...(event.dataTransfer?.items ?? [])].flatMap((item) => item.webkitGetAsEntry() ?? []);
    const found = new Map<string, Blob>();
    try {
      for (const entry of items) await walk(entry, "", found);
    } catch {
      fill(this.problem, "These files cannot be read.");
      return;
    }
    this.use(found);
  }
}
