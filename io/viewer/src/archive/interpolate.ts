/** Value at `x` of what is given at ascending `at[first..end)`; the ends' values beyond them. */
export function interpolated(at: ArrayLike<number>, values: ArrayLike<number>, first: number, end: number, x: number): number {
  if (!(end > first) || !Number.isFinite(x)) return NaN;
  let low = first;
  let high = end - 1;
  if (x <= at[low]!) return values[low]!;
  if (x >= at[high]!) return values[high]!;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (at[middle]! <= x) low = middle;
    else high = middle;
  }
  const share = (x - at[low]!) / (at[high]! - at[low]! || 1);
  return values[low]! + share * (values[high]! - values[low]!);
}
