// How materials answer light: the formulas of articad/render/studio.py, so that the page and the pictures look alike.
// Light is linear. Lamps stand still relative to the camera: a key lamp at the upper left, a fill lamp at the right, a rim lamp behind.
import { Color, DoubleSide, Matrix3, ShaderMaterial, Vector3, Vector4 } from "three";

const vertexShader = `
varying vec3 vNormal;
varying vec3 vPlace; // in view space
varying vec3 vLocal; // in the mesh's own frame
void main() {
  vLocal = position;
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  vNormal = normalMatrix * normal;
  vPlace = place.xyz;
  gl_Position = projectionMatrix * place;
}`;

const fragmentShader = `
uniform vec3 base;
uniform vec3 glow;
uniform float metal, rough, gloss, opaque, fade;
uniform vec3 middle; // of the model, in view space
uniform float size, detail; // of the model [mm]; of the picture: 1 for all pixels
uniform float grain;
uniform mat3 fibre; // from the mesh's frame to one whose x is along its longest side
uniform vec3 up; // the ground's z in view space
uniform bool flat_view; // orthographic: all rays are parallel
#ifdef CUT
uniform vec4 planes[3];
uniform int cuts;
uniform vec2 hatch; // width of a line and distance of two, pixels
#endif
varying vec3 vNormal;
varying vec3 vPlace;
varying vec3 vLocal;

vec3 wood() { // rings: level lines of a function that bends slowly along the fibres
  vec3 p = fibre * vLocal * (110.0 / size);
  float a = 0.06 * p.x, b = p.y, c = p.z;
  float level = b + 0.55 * c + 0.9 * sin(0.35 * b + 0.8 * a) + 0.6 * sin(1.7 * a + 0.23 * c);
  float late = pow(0.5 + 0.5 * sin(2.2 * level), 3.0);
  float fine = 0.5 + 0.5 * sin(7.1 * b + 5.3 * c + 3.0 * sin(0.9 * c + 2.3 * a));
  return pow(vec3(1.0 - grain * (0.20 * late + 0.07 * detail * fine)), vec3(1.0, 1.15, 1.3));
}
vec3 bent(vec3 light) { // unchanged up to 0.7, then bent so that 2 is almost white
  vec3 above = max(light - 0.7, 0.0);
  return min(light, 0.7) + 0.3 * (1.0 - exp(-above / 0.3));
}
vec3 encoded(vec3 c) { // IEC 61966-2-1
  return mix(c * 12.92, 1.055 * pow(max(c, 0.0031308), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
  vec3 normal = normalize(vNormal) * (gl_FrontFacing ? 1.0 : -1.0);
  vec3 eye = flat_view ? vec3(0.0, 0.0, 1.0) : normalize(-vPlace);
#ifdef CUT
  // A ray that meets the inner side of a surface first has entered the part through a plane: the cut, hatched.
  for (int k = 0; k < 3; k++) {
    if (k >= cuts) break;
    if (dot(planes[k].xyz, vPlace) + planes[k].w < 0.0) discard;
  }
  gl_FragDepth = gl_FragCoord.z;
  if (!gl_FrontFacing) {
    gl_FragDepth = gl_FragCoord.z - 5e-4; // before the part's own edges
    float line = mod(gl_FragCoord.x + gl_FragCoord.y, hatch.y) < hatch.x ? 0.45 : 1.0;
    gl_FragColor = vec4(encoded(bent(mix(base, vec3(0.75), 0.25) * line + glow)), 1.0) * fade;
    return;
  }
#endif
  vec3 place = (vPlace - middle) / size, tint = grain > 0.0 ? base * wood() : base;
  vec3 key = normalize(1.5 * vec3(-0.4482, 0.6519, 0.6112) - place), fill = normalize(1.5 * vec3(0.8916, 0.0991, 0.4458) - place);
  vec3 rim = normalize(1.5 * vec3(0.2693, 0.7539, -0.5924) - place);
  float height = dot(normal, up);
  float ambient = 0.40 + 0.14 * height;
  float lamps = 0.74 * max(dot(normal, key), 0.0) + 0.14 * max(dot(normal, fill), 0.0);
  vec3 diffuse = tint * (ambient + lamps);
  float facing = clamp(dot(normal, eye), 0.0, 1.0);
  vec3 mirrored = 2.0 * dot(normal, eye) * normal - eye;
  float spread = clamp(rough, 0.05, 1.0);
  float sharp = 2.0 / (0.02 + pow(spread, 1.6) * 0.55), soft = 1.0 - 0.62 * spread;
  float reflected = 0.34 + (0.34 + 0.22 * metal) * tanh((dot(mirrored, up) + 0.9 * dot(place, up)) / (0.25 + spread)) + 0.12 * (1.0 - spread);
  reflected += soft * (1.9 * exp(sharp * (dot(mirrored, key) - 1.0)) + exp(sharp * (dot(mirrored, fill) - 1.0)) + exp(sharp * (dot(mirrored, rim) - 1.0)));
  reflected = max(reflected, 0.05);
  vec3 mirror = 0.04 * gloss * (1.0 - metal) + tint * 1.12 * metal;
  float grazing = pow(1.0 - facing, 5.0) * (1.0 - 0.75 * spread) * min(gloss, 1.0); // Schlick's Fresnel term
  vec3 fresnel = mirror + (max(mirror, 0.6) - mirror) * grazing;
  vec3 light = diffuse * (1.0 - metal * 0.82) * (1.0 - 0.5 * grazing) + fresnel * reflected * (1.0 + 0.25 * metal);
  float cover = opaque + (1.0 - opaque) * 0.85 * pow(1.0 - facing, 2.5);
  gl_FragColor = vec4(encoded(bent(light + glow)), 1.0) * cover * fade;
}`;

// A material of its own for each shape; \`opacity\` fades it, \`emissive\` lights it up.
export function lookOf(color, finish, shared, geometry) {
  const base = new Color(color); // three keeps it linear
  for (const channel of "rgb") base[channel] = Math.min(Math.max(base[channel], 0.012), 0.86); // the darkest paint and the brightest that exist
  const emissive = new Color(0);
  const material = new ShaderMaterial({
    vertexShader, fragmentShader, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, premultipliedAlpha: true,
    uniforms: {
      base: { value: base }, glow: { value: emissive }, metal: { value: finish.metal }, rough: { value: finish.roughness },
      gloss: { value: finish.gloss }, grain: { value: finish.grain }, fibre: { value: fibreOf(geometry) }, opaque: { value: finish.opacity }, fade: { value: 1 }, ...shared,
    },
  });
  material.emissive = emissive;
  material.clear = finish.opacity < 1;
  return material;
}

// The axes of a mesh's frame in turn, the one along its longest side first.
function fibreOf(geometry) {
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  const sides = geometry.boundingBox.getSize(new Vector3()).toArray(), longest = sides.indexOf(Math.max(...sides));
  const fibre = new Matrix3().set(0, 0, 0, 0, 0, 0, 0, 0, 0);
  for (let row = 0; row < 3; row++) fibre.elements[row + 3 * ((longest + row) % 3)] = 1;
  return fibre;
}

export function refreshLook(material, { faded, opacity, cutting }) {
  material.opacity = material.uniforms.fade.value = faded ? opacity : 1;
  material.transparent = faded || material.clear;
  material.depthWrite = !material.transparent;
  if (Boolean(material.defines?.CUT) !== cutting) {
    material.defines = cutting ? { CUT: 1 } : {};
    material.needsUpdate = true;
  }
}

export const sharedLook = () => ({
  up: { value: new Vector3(0, 0, 1) },
  flat_view: { value: false },
  planes: { value: [new Vector4(), new Vector4(), new Vector4()] },
  cuts: { value: 0 },
  hatch: { value: [1.2, 7] },
  middle: { value: new Vector3() },
  size: { value: 1 },
  detail: { value: 1 },
});
