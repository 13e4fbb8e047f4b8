// Elements are made here and nowhere else: text of the archive reaches the page as text nodes and attributes, never as
// markup. Styles that depend on data are set through the object model, which the content-security policy allows.

import { unitText } from "../archive/words";

export type Child = Node | string | number | null | undefined | false | Child[];

interface Props {
  class?: string;
  title?: string;
  on?: { [E in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[E]) => void };
  [attribute: string]: unknown;
}

export function h<K extends keyof HTMLElementTagNameMap>(tag: K, props: Props = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(props)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === "on")
      for (const [event, act] of Object.entries(value as object)) made.addEventListener(event, act as EventListener);
    else made.setAttribute(name, value === true ? "" : String(value));
  }
  add(made, children);
  return made;
}

function add(parent: Node, children: Child[]): void {
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    if (Array.isArray(child)) add(parent, child);
    else parent.appendChild(child instanceof Node ? child : document.createTextNode(String(child)));
  }
}

/** Replaces what `parent` holds. The keyboard stays with the control that takes the place of the one it was with. */
export function fill(parent: Element, ...children: Child[]): void {
  const active = document.activeElement;
  const place = active && active !== parent && parent.contains(active) ? controls(parent).indexOf(active as HTMLElement) : -1;
  const name = place >= 0 ? nameOf(active!) : "";
  parent.replaceChildren();
  add(parent, children);
  if (place < 0) return;
  const made = controls(parent);
  (made.find((control) => nameOf(control) === name) ?? made[place])?.focus({ preventScroll: true });
}

const controls = (parent: Element): HTMLElement[] => [...parent.querySelectorAll<HTMLElement>("a, button, input, select, [tabindex]")];

/** What a control is called: the text of its label or its own, without the mark of a sorted column. */
const nameOf = (control: Element): string =>
  control.getAttribute("aria-label") ?? (control as HTMLInputElement).labels?.[0]?.textContent ?? control.querySelector(".label")?.textContent ?? control.textContent ?? "";

let labels = 0;

/** A labelled choice. */
export function choice(
  label: string, options: readonly (readonly [value: string, text: string])[], value: string, changed: (value: string) => void,
): { root: HTMLElement; select: HTMLSelectElement } {
  const id = `choice-${labels++}`;
  const select = h("select", { id, on: { change: () => changed(select.value) } }, options.map(([key, text]) => h("option", { value: key }, text)));
  select.value = value;
  return { root: h("div", { class: "field" }, h("label", { for: id }, label), select), select };
}

export function checkbox(label: string, checked: boolean, changed: (checked: boolean) => void): HTMLLabelElement {
  const box = h("input", { type: "checkbox", checked, on: { change: () => changed(box.checked) } });
  return h("label", { class: "check" }, box, h("span", {}, label));
}

export function slider(
  label: string, low: number, high: number, step: number, value: number, changed: (value: number) => void,
): { root: HTMLElement; input: HTMLInputElement } {
  const id = `choice-${labels++}`;
  const input = h("input", { id, type: "range", min: low, max: high, step, on: { input: () => changed(Number(input.value)) } });
  input.value = String(value);
  return { root: h("div", { class: "field" }, h("label", { for: id }, label), input), input };
}

/** Four significant digits, as many as a figure in a table is read for. */
export function number(x: number | undefined | null): string {
  if (x === undefined || x === null || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "-∞";
  if (Number.isInteger(x) && Math.abs(x) < 1e7) return String(x);
  const size = Math.abs(x);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return x.toExponential(2).replace("e", "e");
  return String(Number(x.toPrecision(4)));
}

export const withUnits = (x: number, units: string): string =>
  unitText(units) && !Number.isNaN(x) ? `${number(x)} ${unitText(units)}` : number(x);

/** Gives `name` to the user as a file. */
export function download(blob: Blob, name: string): void {
  const url = URL.createObjectURL(blob);
  const link = h("a", { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** What a failure says. */
export const sentenceOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));

/** Sentences of failures, as a view shows them. */
export const problems = (sentences: string[]): HTMLElement[] =>
  [...new Set(sentences)].map((sentence) => h("p", { class: "problem", role: "alert" }, sentence));
