// Names of the archive as a reader knows them. Whatever is not listed here is shown under its own name.

interface Words {
  label: string;
  symbol?: string;
}

const kWords: Record<string, Words> = {
  geodesic_distance: { label: "Geodesic distance", symbol: "D_g" },
  euclidean_distance: { label: "Euclidean distance", symbol: "D_e" },
  normalized_tangency_deviation: { label: "Tangency deviation", symbol: "NTD" },
  geodesic_distance_refined: { label: "Geodesic distance, refined", symbol: "D_g refined" },
  normalized_tangency_deviation_refined: { label: "Tangency deviation, refined", symbol: "NTD refined" },
  descent_length: { label: "Length of the descent" },
  abscissa: { label: "Abscissa", symbol: "s" },
  centerline_id: { label: "Centerline" },
  branch_id: { label: "Branch" },
  zone: { label: "Zone" },
  origin: { label: "Origin" },
  line_radius: { label: "Radius of the line" },
  line_clearance: { label: "Clearance of the line" },
  ball_radius: { label: "Ball radius", symbol: "R" },
  arrival_time: { label: "Arrival time", symbol: "T" },
  centerline_distance: { label: "Distance to centerlines", symbol: "T~" },
  radius: { label: "Radius", symbol: "r" },
  clearance: { label: "Clearance" },
  radius_error: { label: "Error of the radius" },
  position_error: { label: "Error of the position" },
  curvature: { label: "Curvature" },
  torsion: { label: "Torsion" },
  area: { label: "Area of the section" },
};

export const labelOf = (key: string): string => {
  const known = kWords[key]?.label;
  if (known) return known;
  const words = key.replaceAll("_", " ").trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
};

export const symbolOf = (key: string): string => kWords[key]?.symbol ?? "";

/** Heading of a column of the cohort's table: "geodesic_distance_mean" is "D_g mean". */
export function columnLabel(name: string): string {
  for (const end of ["mean", "sd", "median", "p95"]) {
    const key = name.slice(0, -end.length - 1);
    if (name === `${key}_${end}` && (kWords[key]?.symbol?.length ?? 0) > 1) return `${kWords[key].symbol} ${end}`;
  }
  return name.replaceAll("_", " ");
}

/** Units as text behind a number; nothing for plain numbers, and where the archive does not know the unit of length. */
export const unitText = (units: string): string => (units === "1" || units.includes("unknown") ? "" : units);
