// The frame around the views: which archive is open, which view the address asks for, what goes wrong. The address
// behind the # is the whole state that a link restores: #/, #/model/ID?..., #/compare/A/B?...
import { Client } from "./archive/client";
import type { Cohort, Opened } from "./archive/protocol";
import { CohortView } from "./cohort/view";
import { CompareView } from "./compare/view";
import { ModelView } from "./model/view";
import { fill, h, sentenceOf } from "./ui/dom";
import { showHelp } from "./ui/help";
import { StartView } from "./ui/start";
import { columnOf } from "./cohort/rows";
import { nextTheme, themeName } from "./ui/theme";

export interface View {
  readonly root: HTMLElement;
  dispose?(): void;
  key?(event: KeyboardEvent): void;
}

export interface Route {
  view: "cohort" | "model" | "compare";
  ids: string[];
  state: URLSearchParams;
}

export function parseRoute(hash: string): Route {
  const [path = "", query = ""] = hash.replace(/^#\/?/, "").split("?", 2);
  const [view, ...ids] = path.split("/").map((part) => {
    try {
      return decodeURIComponent(part);
    } catch {
      return part;
    }
  });
  return { view: view === "model" || view === "compare" ? view : "cohort", ids, state: new URLSearchParams(query) };
}

export class App {
  readonly client = new Client();
  cohort: Cohort | null = null;
  private cohortView: CohortView | null = null; // kept, so that filters survive a look at a model
  private view: View | null = null;
  private readonly stage = h("div", { class: "stage" });
  private readonly nav = h("nav", { "aria-label": "views" });
  private readonly title = h("span", { class: "archive-name" });
  private readonly progress = h("span", { class: "progress", role: "status" });
  private address = ""; // of the view that is shown
  private opens = 0;

  constructor(root: Element) {
    const themeButton = h("button", { type: "button", class: "quiet", on: { click: () => (nextTheme(), name()) } });
    const name = () => fill(themeButton, `Theme: ${themeName()}`);
    name();
    fill(root,
      h("header", {}, h("a", { class: "brand", href: "#/" }, "Lumenline"), this.title, this.nav, h("span", { class: "grow" }), this.progress,
        themeButton,
        h("button", { type: "button", class: "quiet", title: "Open another archive", on: { click: () => this.start() } }, "Open…"),
        h("button", { type: "button", class: "quiet", title: "Keys and help (?)", on: { click: () => showHelp() } }, "?")),
      this.stage);
    this.client.onProgress = (bytes, busy) => {
      this.progress.classList.toggle("busy", busy);
      fill(this.progress, busy && "reading", bytes > 0 && ` ${(bytes / 1e6).toFixed(1)} MB`);
    };
    addEventListener("hashchange", () => {
      if (location.hash !== this.address) this.route();
    });
    // A link to the address that stands there already is no change of it, but another view may cover what it shows.
    root.addEventListener("click", (event) => {
      const link = (event.target as Element).closest<HTMLAnchorElement>("a[href^='#']");
      if (link?.hash === location.hash) this.route();
    });
    window.addEventListener("keydown", (event) => this.key(event));
  }

  /** Asks for an archive. */
  start(): void {
    this.show(new StartView((opened) => void this.open(opened)));
  }

  async open(opened: Opened): Promise<void> {
    const reading: View = { root: h("main", { class: "message" }, h("p", {}, `Reading ${opened.name} …`)) };
    const turn = ++this.opens;
    this.show(reading);
    this.cohort = null;
    this.cohortView = null;
    fill(this.title);
    fill(this.nav);
    try {
      const cohort = await this.client.open(opened);
      if (turn !== this.opens) return;
      this.cohort = cohort;
    } catch (error) {
      if (turn === this.opens) this.fail(error);
      return;
    }
    fill(this.title, this.cohort.name);
    document.title = `${this.cohort.name} – Lumenline`;
    // Models of the archive that was open before are none of this one.
    if (turn > 1 && !parseRoute(location.hash).ids.every((id) => this.ids().includes(id))) this.replace("#/");
    if (this.view === reading) this.route();
    else this.navigate("cohort", []);
  }

  ids(): string[] {
    return this.cohort ? (columnOf(this.cohort.models, "id")?.texts ?? []) : [];
  }

  go(hash: string): void {
    if (location.hash === hash) this.route();
    else location.hash = hash;
  }

  /** Writes the state of the view that is shown into the address, without a step in the history. */
  remember(hash: string): void {
    if (location.hash !== this.address) return; // another view was asked for, and the event that tells is on its way
    this.replace(hash);
    this.address = location.hash;
  }

  fail(error: unknown): void {
    const sentence = sentenceOf(error);
    this.show({
      root: h("main", { class: "message error", role: "alert" }, h("h1", {}, "This cannot be shown"), h("p", {}, sentence),
        h("p", {}, this.cohort ? h("a", { href: "#/" }, this.cohort.isModelFile ? "Show the model" : "Back to the cohort") : h("button", { type: "button", on: { click: () => this.start() } }, "Open an archive"))),
    });
  }

  private replace(hash: string): void {
    history.replaceState(null, "", location.pathname + location.search + hash);
  }

  private show(view: View): void {
    this.view?.dispose?.();
    this.view = view;
    fill(this.stage, view.root);
  }

  private route(): void {
    if (!this.cohort) return;
    if (this.cohort.isModelFile && parseRoute(location.hash).view === "cohort")
      this.replace(`#/model/${encodeURIComponent(this.ids()[0] ?? "")}`);
    this.address = location.hash;
    const { view, ids, state } = parseRoute(location.hash);
    this.navigate(view, ids);
    if (view === "model") this.show(new ModelView(this, ids[0] ?? "", state));
    else if (view === "compare") this.show(new CompareView(this, ids[0] ?? "", ids[1] ?? "", state));
    else this.show({ root: (this.cohortView ??= new CohortView(this, this.cohort)).root });
  }

  private navigate(view: Route["view"], ids: string[]): void {
    const all = this.ids();
    const first = ids[0] || all[0] || "";
    const second = all[(all.indexOf(first) + 1) % Math.max(1, all.length)] ?? first;
    const link = (name: Route["view"], text: string, href: string) =>
      h("a", { href, "aria-current": view === name ? "page" : undefined }, text);
    fill(this.nav, !this.cohort?.isModelFile && link("cohort", "Cohort", "#/"),
      link("model", "Model", `#/model/${encodeURIComponent(first)}`),
      !this.cohort?.isModelFile && link("compare", "Compare", `#/compare/${encodeURIComponent(first)}/${encodeURIComponent(second)}`));
  }

  private key(event: KeyboardEvent): void {
    const typing = event.target instanceof HTMLInputElement && !["checkbox", "range"].includes(event.target.type);
    if (typing || event.target instanceof HTMLSelectElement || event.ctrlKey || event.metaKey || event.altKey) return;
    if (document.querySelector("dialog[open]")) return;
    const moves = /^(Arrow|Page|Home|End)/.test(event.key);
    if (moves && (event.target as Element).closest("input, .small-table, .table-scroll")) return; // these move themselves
    if (event.key === "?") showHelp();
    else if (event.key === "/" && this.view?.root === this.cohortView?.root) {
      this.cohortView?.focusSearch();
      event.preventDefault();
    } else if (event.key === "g") this.go("#/");
    else this.view?.key?.(event);
  }
}
