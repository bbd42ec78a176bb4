// What lies between parts: the soft shadow on the ground, and the darkness where surfaces are near each other.
import {
  AddEquation, CustomBlending, DepthTexture, DoubleSide, Mesh, MeshNormalMaterial, NoBlending, OneFactor,
  OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, SrcColorFactor, Vector2, WebGLRenderTarget, ZeroFactor,
} from "three";

export const PARTS = 0, MARKS = 1; // layers: surfaces of parts, and all else

const quadVertex = "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }";

class Pass {
  constructor(fragmentShader, uniforms, options = {}) {
    this.material = new ShaderMaterial({ vertexShader: quadVertex, fragmentShader, uniforms, depthTest: false, depthWrite: false, blending: NoBlending, ...options });
    this.uniforms = this.material.uniforms;
    this.scene = new Scene();
    this.scene.add(new Mesh(new PlaneGeometry(2, 2), this.material));
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  }

  draw(renderer, target) {
    renderer.setRenderTarget(target);
    renderer.render(this.scene, this.camera);
  }
}

// A picture that was drawn elsewhere, on the canvas. It is encoded already.
export class Copy {
  constructor() {
    this.pass = new Pass("uniform sampler2D image; varying vec2 at; void main() { gl_FragColor = texture2D(image, at); }", { image: { value: null } });
  }

  draw(renderer, texture) {
    this.pass.uniforms.image.value = texture;
    this.pass.draw(renderer, null);
  }
}

const SHADOW_PIXELS = 192;

// The shadow on the ground: heights of parts seen from below, blurred, more the higher they are.
export class GroundShadow {
  constructor(scene, box, size) {
    const middle = box.min.clone().add(box.max).multiplyScalar(0.5);
    const across = Math.max(box.max.x - box.min.x, box.max.y - box.min.y) + 0.5 * size;
    this.level = box.min.z;
    this.camera = new OrthographicCamera(-across / 2, across / 2, across / 2, -across / 2, 0, 0.4 * size);
    this.camera.position.set(middle.x, middle.y, this.level - 1e-3 * size);
    this.camera.up.set(0, 1, 0);
    this.camera.lookAt(middle.x, middle.y, this.level + size);
    this.camera.layers.set(PARTS);
    this.camera.updateMatrixWorld();
    this.heights = new ShaderMaterial({
      side: DoubleSide, blending: NoBlending,
      vertexShader: "varying float far; void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); far = gl_Position.z * 0.5 + 0.5; }",
      fragmentShader: "varying float far; void main() { gl_FragColor = vec4(1.0 - far, 0.0, 0.0, 1.0); }",
    });
    const target = () => new WebGLRenderTarget(SHADOW_PIXELS, SHADOW_PIXELS, { depthBuffer: true });
    this.targets = [target(), target()];
    this.blur = new Pass(`
      uniform sampler2D image; uniform vec2 way; varying vec2 at;
      void main() {
        float sum = 0.0, weight = 0.0;
        for (int k = -6; k <= 6; k++) {
          float w = exp(-float(k * k) / 14.0);
          sum += w * texture2D(image, at + way * float(k)).r;
          weight += w;
        }
        gl_FragColor = vec4(sum / weight, 0.0, 0.0, 1.0);
      }`, { image: { value: null }, way: { value: new Vector2() } });
    this.ground = new Mesh(
      new PlaneGeometry(across, across),
      new ShaderMaterial({
        transparent: true, depthWrite: false, side: DoubleSide,
        uniforms: { image: { value: this.targets[0].texture }, strength: { value: 1 } },
        vertexShader: "varying vec2 at; void main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
        fragmentShader: `
          uniform sampler2D image; uniform float strength; varying vec2 at;
          void main() {
            vec2 from = abs(at - 0.5) * 2.0;
            float rim = (1.0 - smoothstep(0.75, 1.0, from.x)) * (1.0 - smoothstep(0.75, 1.0, from.y));
            float dark = texture2D(image, vec2(1.0 - at.x, at.y)).r; // seen from below;
            gl_FragColor = vec4(0.0, 0.0, 0.0, 0.62 * strength * rim * pow(clamp(dark, 0.0, 1.0), 1.25));
          }`,
      }));
    this.ground.position.set(middle.x, middle.y, this.level - 1e-3 * size);
    this.ground.layers.set(MARKS);
    this.ground.renderOrder = -1;
    scene.add(this.ground);
  }

  draw(renderer, scene, show) {
    const [first, second] = this.targets;
    const background = scene.overrideMaterial;
    scene.overrideMaterial = this.heights;
    const hidden = show(false);
    renderer.setRenderTarget(first);
    renderer.clear();
    renderer.render(scene, this.camera);
    scene.overrideMaterial = background;
    hidden();
    for (const [width, from, to] of [[2.2, first, second], [2.2, second, first], [0.8, first, second], [0.8, second, first]]) {
      this.blur.uniforms.image.value = from.texture;
      this.blur.uniforms.way.value.set(from === first ? width / SHADOW_PIXELS : 0, from === first ? 0 : width / SHADOW_PIXELS);
      this.blur.draw(renderer, to);
    }
    renderer.setRenderTarget(null);
  }
}

const occlusionShader = `
uniform sampler2D depths, normals;
uniform mat4 projection, unprojection;
uniform float reach;
uniform vec2 size;
varying vec2 at;
vec3 placeOf(vec2 uv) {
  vec4 place = unprojection * vec4(vec3(uv, texture2D(depths, uv).r) * 2.0 - 1.0, 1.0);
  return place.xyz / place.w;
}
void main() {
  float depth = texture2D(depths, at).r;
  if (depth >= 1.0) { gl_FragColor = vec4(1.0); return; }
  vec3 place = placeOf(at), normal = normalize(texture2D(normals, at).rgb * 2.0 - 1.0);
  float turn = 6.2832 * fract(52.9829 * fract(dot(floor(at * size), vec2(0.06711, 0.00584)))); // interleaved gradient noise
  float dark = 0.0;
  for (int k = 0; k < 14; k++) {
    float share = (float(k) + 0.5) / 14.0, angle = turn + float(k) * 2.39996;
    vec3 way = vec3(cos(angle) * sqrt(1.0 - share * share), sin(angle) * sqrt(1.0 - share * share), share);
    vec3 across = normalize(abs(normal.z) < 0.9 ? cross(normal, vec3(0.0, 0.0, 1.0)) : cross(normal, vec3(1.0, 0.0, 0.0)));
    way = across * way.x + cross(normal, across) * way.y + normal * (way.z + 0.12);
    vec3 there = place + way * reach * mix(0.15, 1.0, fract(share * 7.3 + turn));
    vec4 clip = projection * vec4(there, 1.0);
    vec2 uv = clip.xy / clip.w * 0.5 + 0.5;
    float front = placeOf(uv).z - there.z;
    dark += step(0.015 * reach, front) * (1.0 - smoothstep(0.5, 1.0, front / (2.0 * reach)));
  }
  gl_FragColor = vec4(vec3(1.0 - dark / 14.0), 1.0);
}`;

const appliedShader = `
uniform sampler2D image;
uniform vec2 step_;
varying vec2 at;
void main() {
  float sum = 0.0;
  for (int x = -2; x <= 2; x++) for (int y = -2; y <= 2; y++) sum += texture2D(image, at + step_ * vec2(float(x), float(y))).r;
  gl_FragColor = vec4(vec3(mix(0.42, 1.0, smoothstep(0.0, 0.95, sum / 25.0))), 1.0);
}`;

// Ambient occlusion in screen space, multiplied into a finished picture. It costs as much as several frames: for pictures that stand still.
export class Occlusion {
  constructor() {
    this.normals = new MeshNormalMaterial({ side: DoubleSide, blending: NoBlending });
    this.find = new Pass(occlusionShader, {
      depths: { value: null }, normals: { value: null }, projection: { value: null }, unprojection: { value: null }, reach: { value: 1 }, size: { value: new Vector2() },
    });
    this.apply = new Pass(appliedShader, { image: { value: null }, step_: { value: new Vector2() } }, {
      blending: CustomBlending, blendEquation: AddEquation, blendSrc: ZeroFactor, blendDst: SrcColorFactor, blendSrcAlpha: ZeroFactor, blendDstAlpha: OneFactor, transparent: true,
    });
  }

  draw(renderer, scene, camera, { reach, planes, show }) {
    const pixels = renderer.getDrawingBufferSize(new Vector2());
    const width = Math.max(1, Math.ceil(pixels.x / 2)), height = Math.max(1, Math.ceil(pixels.y / 2));
    if (this.first?.width !== width || this.first?.height !== height) {
      this.first?.dispose();
      this.second?.dispose();
      this.first = new WebGLRenderTarget(width, height, { depthTexture: new DepthTexture(width, height) });
      this.second = new WebGLRenderTarget(width, height, { depthBuffer: false });
    }
    const layers = camera.layers.mask;
    camera.layers.set(PARTS);
    this.normals.clippingPlanes = planes;
    scene.overrideMaterial = this.normals;
    const shown = show(true);
    renderer.setRenderTarget(this.first);
    renderer.clear();
    renderer.render(scene, camera);
    shown();
    scene.overrideMaterial = null;
    camera.layers.mask = layers;
    Object.assign(this.find.uniforms.depths, { value: this.first.depthTexture });
    this.find.uniforms.normals.value = this.first.texture;
    this.find.uniforms.projection.value = camera.projectionMatrix;
    this.find.uniforms.unprojection.value = camera.projectionMatrixInverse;
    this.find.uniforms.reach.value = reach;
    this.find.uniforms.size.value.set(width, height);
    this.find.draw(renderer, this.second);
    this.apply.uniforms.image.value = this.second.texture;
    this.apply.uniforms.step_.value.set(1 / width, 1 / height);
    renderer.autoClear = false;
    this.apply.draw(renderer, null);
    renderer.autoClear = true;
  }
}
