// One material for everything that is coloured by a quantity: values go to the graphics card, and colour map and range
// are looked up there, so that changing them costs nothing. What has no value (NaN on the way in) carries a huge
// negative number instead, since not every graphics card keeps NaN; a triangle with one such corner is grey.
import * as THREE from "three";
import { categoryBytes, kCategories, mapBytes, type MapName } from "../ui/colours";

export const kMissing = -1e30;

const kVertex = /* glsl */ `
  attribute float value;
  varying vec3 vNormal;
  varying vec3 vToEye;
  varying float vValue;
  flat varying float vCategory;
  void main() {
    vec4 at = vec4(position, 1.0);
    vec3 n = normal;
    #ifdef USE_INSTANCING
      at = instanceMatrix * at;
      n = mat3(instanceMatrix) * n;
    #endif
    vec4 view = modelViewMatrix * at;
    vNormal = normalMatrix * n;
    vToEye = -view.xyz;
    vValue = value;
    vCategory = value;
    gl_Position = projectionMatrix * view;
  }`;

// A light at the eye shows form without hiding sides; a rim makes a transparent wall read as a vessel.
const kFragment = /* glsl */ `
  uniform sampler2D map;
  uniform sampler2D palette;
  uniform vec2 range;
  uniform int mode;
  uniform float opacity;
  uniform float rim;
  uniform bool flatShading;
  uniform float shade;
  uniform vec3 plain;
  uniform vec3 missing;
  varying vec3 vNormal;
  varying vec3 vToEye;
  varying float vValue;
  flat varying float vCategory;
  void main() {
    vec3 eye = normalize(vToEye);
    vec3 n = flatShading ? normalize(cross(dFdx(vToEye), dFdy(vToEye))) : normalize(vNormal);
    float facing = abs(dot(n, eye));
    vec3 colour = plain;
    if (mode == 1) {
      float t = (vValue - range.x) / max(range.y - range.x, 1e-30);
      colour = vValue < -1e29 ? missing : texture2D(map, vec2(clamp(t, 0.002, 0.998), 0.5)).rgb;
    } else if (mode == 2) {
      float index = mod(floor(vCategory + 0.5), ${kCategories.length.toFixed(1)});
      colour = vCategory < -1e29 ? missing : texture2D(palette, vec2((index + 0.5) / ${kCategories.length.toFixed(1)}, 0.5)).rgb;
    }
    float light = 1.0 - shade + shade * facing;
    float shine = 0.10 * pow(facing, 24.0);
    float alpha = opacity + (1.0 - opacity) * rim * pow(1.0 - facing, 2.5);
    gl_FragColor = vec4(colour * light + shine, alpha);
  }`;

function texture(bytes: Uint8Array, filter: THREE.MagnificationTextureFilter): THREE.DataTexture {
  const made = new THREE.DataTexture(bytes as Uint8Array<ArrayBuffer>, bytes.length / 4, 1);
  made.magFilter = filter;
  made.minFilter = filter as THREE.MinificationTextureFilter;
  made.needsUpdate = true;
  return made;
}

const maps = new Map<MapName, THREE.DataTexture>();
const palette = texture(categoryBytes(), THREE.NearestFilter);

function mapTexture(name: MapName): THREE.DataTexture {
  const known = maps.get(name);
  if (known) return known;
  const made = texture(mapBytes(name, 256), THREE.LinearFilter);
  maps.set(name, made);
  return made;
}

export type ColourMode = "plain" | "scale" | "category";

export interface Look {
  mode: ColourMode;
  map: MapName;
  range: [number, number];
  opacity: number;
}

export class FieldMaterial extends THREE.ShaderMaterial {
  constructor(plain: number, options: { flat?: boolean; side?: THREE.Side; rim?: number } = {}) {
    super({
      vertexShader: kVertex,
      fragmentShader: kFragment,
      side: options.side ?? THREE.DoubleSide,
      uniforms: {
        map: { value: mapTexture("viridis") },
        palette: { value: palette },
        range: { value: new THREE.Vector2(0, 1) },
        mode: { value: 0 },
        opacity: { value: 1 },
        rim: { value: options.rim ?? 0 },
        flatShading: { value: options.flat ?? false },
        shade: { value: options.flat ? 0.25 : 0.48 }, // facets that stand every way would hide the colours
        plain: { value: new THREE.Color() },
        missing: { value: new THREE.Color() },
      },
    });
    this.setPlain(plain);
    // Colours are shown as they are stated: without a change of colour space on the way.
    (this.uniforms.missing!.value as THREE.Color).setHex(0x9a9fa3, THREE.LinearSRGBColorSpace);
  }

  setPlain(colour: number): void {
    (this.uniforms.plain!.value as THREE.Color).setHex(colour, THREE.LinearSRGBColorSpace);
  }

  show(look: Look): void {
    this.uniforms.map!.value = mapTexture(look.map);
    (this.uniforms.range!.value as THREE.Vector2).set(...look.range);
    this.uniforms.mode!.value = { plain: 0, scale: 1, category: 2 }[look.mode];
    this.uniforms.opacity!.value = look.opacity;
    const seeThrough = look.opacity < 1;
    if (this.transparent !== seeThrough) this.needsUpdate = true;
    this.transparent = seeThrough;
    this.depthWrite = !seeThrough;
  }
}

/** `values` as the material reads them. */
export function forMaterial(values: Float32Array): Float32Array {
  return values.map((x) => (Number.isFinite(x) ? x : kMissing));
}
