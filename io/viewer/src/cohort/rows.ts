// Rows of a table as the cohort view thinks of them: filtered by words and comparisons, sorted by a column, grouped.
import type { Column, Table } from "../archive/protocol";

export const columnOf = (table: Table, name: string): Column | undefined =>
  table.columns.find((column) => column.name === name);

/** Numbers of which there is at least one: what can be plotted. */
export function measures(table: Table): Column[] {
  return table.columns.filter((column) => column.numbers?.some((x) => Number.isFinite(x)));
}

/** "n/a" says in a table what an empty cell does. */
const isMissing = (text: string): boolean => text === "" || text === "n/a";

const kNoGrouping = /^(source_|inputs_|id$)/;
const kMostGroups = 40;

/** Columns by whose few values the models fall into groups; the one that is meant to may have more of them. */
export function groupings(table: Table, most = 12): Column[] {
  return table.columns.filter((column) => {
    if (!column.texts || kNoGrouping.test(column.name)) return false;
    const values = new Set(column.texts.map((text) => (isMissing(text) ? "" : text)));
    return values.size >= 2 && values.size <= (column.name === "group" ? kMostGroups : Math.min(most, Math.max(2, table.rows / 2)));
  });
}

export interface Groups {
  names: string[];
  of: Int32Array; // group of each row
}

/** The groups of a column in the order of their names; one group without a column. */
export function groupsOf(table: Table, column: Column | undefined): Groups {
  const texts = column?.texts?.map((text) => (isMissing(text) ? "" : text));
  if (!texts) return { names: ["all"], of: new Int32Array(table.rows) };
  const names = [...new Set(texts)].sort((a, b) => Number(a === "") - Number(b === "") || a.localeCompare(b, "en", { numeric: true }));
  const index = new Map(names.map((name, i) => [name, i]));
  return { names: names.map((name) => name || "(none)"), of: Int32Array.from(texts, (text) => index.get(text)!) };
}

type Test = (row: number) => boolean;

const kComparison = /^(.+?)(<=|>=|!=|<|>|=|:)(.*)$/;

function words(query: string): string[] {
  return [...query.matchAll(/(?:[^\s"]|"[^"]*"?)+/g)].map((match) => match[0].replaceAll('"', ""));
}

function named(table: Table, name: string): Column | undefined {
  const wanted = name.toLowerCase().replaceAll(" ", "_");
  const key = (text: string) => text.toLowerCase().replaceAll(" ", "_");
  return (
    table.columns.find((column) => key(column.name) === wanted || key(column.label) === wanted) ??
    table.columns.find((column) => key(column.name).startsWith(wanted) || key(column.label).startsWith(wanted))
  );
}

/** The column's numbers; those of texts, if all that say something are numbers. */
function numbersOf(column: Column): ArrayLike<number> | null {
  if (column.numbers) return column.numbers;
  const numbers = column.texts!.map((text) => (isMissing(text) ? NaN : Number(text)));
  return column.texts!.every((text, row) => isMissing(text) || !Number.isNaN(numbers[row]!)) ? numbers : null;
}

/** What is missing meets no condition but the one that asks for it: `column=`. */
function comparison(column: Column, sign: string, text: string): Test | null {
  const { texts } = column;
  const isKnown: Test = texts ? (row) => !isMissing(texts[row]!) : (row) => !Number.isNaN(column.numbers![row]!);
  if (isMissing(text) && /^(=|:|!=)$/.test(sign)) return (row) => isKnown(row) === (sign === "!=");
  if (!texts || /^[<>]/.test(sign)) {
    const numbers = numbersOf(column);
    const limit = Number(text);
    if (!numbers || text === "" || Number.isNaN(limit)) return null;
    if (sign === "<") return (row) => numbers[row]! < limit;
    if (sign === ">") return (row) => numbers[row]! > limit;
    if (sign === "<=") return (row) => numbers[row]! <= limit;
    if (sign === ">=") return (row) => numbers[row]! >= limit;
    return (row) => isKnown(row) && (numbers[row] === limit) === (sign !== "!=");
  }
  const wanted = text.toLowerCase();
  if (sign === ":") return (row) => texts[row]!.toLowerCase().includes(wanted);
  return (row) => isKnown(row) && (texts[row]!.toLowerCase() === wanted) === (sign !== "!=");
}

export interface Query {
  test: Test;
  unclear: string[]; // words that look like comparisons but cannot be understood
}

/** Words that all must occur in some text of a row, and comparisons like `radius_min<2` or `group=patient`. */
export function parseQuery(table: Table, query: string): Query {
  const texts = table.columns.flatMap((column) => (column.texts ? [column.texts] : []));
  const tests: Test[] = [];
  const unclear: string[] = [];
  for (const word of words(query)) {
    const parts = kComparison.exec(word);
    if (parts) {
      const column = named(table, parts[1]!);
      const test = column && comparison(column, parts[2]!, parts[3]!);
      if (test) tests.push(test);
      else unclear.push(word);
      continue;
    }
    const wanted = word.toLowerCase();
    tests.push((row) => texts.some((column) => column[row]!.toLowerCase().includes(wanted)));
  }
  return { test: (row) => tests.every((test) => test(row)), unclear };
}

const collator = new Intl.Collator("en", { numeric: true });

/** Sorts rows by a column; what is missing comes last either way. */
export function sortRows(rows: number[], column: Column | undefined, descending: boolean): number[] {
  if (!column) return rows;
  const sign = descending ? -1 : 1;
  const { numbers, texts } = column;
  return [...rows].sort((a, b) => {
    if (numbers) {
      const [x, y] = [numbers[a]!, numbers[b]!];
      const missing = Number(Number.isNaN(x)) - Number(Number.isNaN(y));
      return missing || sign * (x - y) || a - b;
    }
    const [x, y] = [texts![a]!, texts![b]!];
    return Number(isMissing(x)) - Number(isMissing(y)) || sign * collator.compare(x, y) || a - b;
  });
}
