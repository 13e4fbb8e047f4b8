// Light, dark, or as the system has it; remembered where the browser allows it.
const kKey = "lumenline-theme";
const kThemes = ["system", "light", "dark"] as const;

let chosen: (typeof kThemes)[number] = "system";

function apply(): void {
  const dark = chosen === "dark" || (chosen === "system" && matchMedia("(prefers-color-scheme: dark)").matches);
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  dispatchEvent(new Event("themechange"));
}

export const themeName = (): string => chosen;

export function useTheme(): void {
  try {
    const kept = localStorage.getItem(kKey);
    chosen = kThemes.find((name) => name === kept) ?? "system";
  } catch {
    // Pages opened as files may have no storage.
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", apply);
  apply();
}

export function nextTheme(): void {
  chosen = kThemes[(kThemes.indexOf(chosen) + 1) % kThemes.length]!;
  try {
    localStorage.setItem(kKey, chosen);
  } catch {
    // As above.
  }
  apply();
}
