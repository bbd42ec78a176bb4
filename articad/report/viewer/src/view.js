// What is drawn: one group per part, moved as a whole; frames when something has changed and at no other time.
// Frames in motion are drawn in as many pixels as the machine manages; one frame of full quality follows when all is still.
import {
  Box3, BufferAttribute, BufferGeometry, Color, ConeGeometry, DoubleSide, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, OrthographicCamera, PerspectiveCamera, Plane, Raycaster, Scene, Sphere, SphereGeometry, Vector2, Vector3, WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { fromPose, multiply } from "./kinematics.js";
import { lookOf, refreshLook, sharedLook } from "./look.js";
import { Copy, GroundShadow, MARKS, Occlusion, PARTS } from "./shade.js";
import { featureAt } from "./features.js";

const INK = 0x20242a, CHALK = 0x737a84; // edges, and edges of black parts
const EDGE = 0.5; // opacity of edges
const JOINT = 0x1f8ae0, MARK = 0xe5383b;
const AXES = [0xd33a3a, 0x2a9b48, 0x3a66d8];
const FADED = 0.12; // opacity of parts that a finding is not about
const FIELD = 32; // degrees
const FILLED = 0.84; // of the picture's height or width, by the model
const TOOLS = 110; // pixels that the tools take at the upper and lower edge
const STILL = 140; // ms without a change until the frame of full quality
const SLOW = 48, QUICK = 26; // ms of a frame: draw fewer pixels, or more
const SCALES = [1, 0.75, 0.55, 0.4, 0.3]; // of the pixels in each direction, while something moves
const NEAR_EDGE = 8, NEAR_CORNER = 12; // pixels within which an edge or a corner is caught
const BESIDE = 4; // pixels beside the outline of a part within which it is still meant
export const DIRECTIONS = {
  iso: [1, -1.4, 0.9], front: [0, -1, 0], back: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0], top: [0, -1e-4, 1], bottom: [0, -1e-4, -1],
};

export function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

const indices = (base64, wide) => (wide ? new Uint32Array(bytesOf(base64)) : new Uint16Array(bytesOf(base64)));

// Triangles come sorted by smooth face. A vertex gets one copy per face, so that normals are smooth in a face and sharp between two.
function geometryOf(mesh) {
  const points = new Float32Array(bytesOf(mesh.vertices));
  const triangles = indices(mesh.triangles, mesh.wide);
  const counts = new Uint32Array(bytesOf(mesh.faces));
  const copyOf = new Int32Array(points.length / 3).fill(-1);
  const faceOf = new Int32Array(points.length / 3).fill(-1);
  const source = [];
  const index = new Uint32Array(triangles.length);
  const starts = [0];
  for (let face = 0, at = 0; face < counts.length; face++) {
    for (const end = at + 3 * counts[face]; at < end; at++) {
      const vertex = triangles[at];
      if (faceOf[vertex] !== face) {
        faceOf[vertex] = face;
        copyOf[vertex] = source.length;
        source.push(vertex);
      }
      index[at] = copyOf[vertex];
    }
    starts.push(at / 3);
  }
  const positions = new Float32Array(source.length * 3);
  source.forEach((vertex, copy) => positions.set(points.subarray(3 * vertex, 3 * vertex + 3), 3 * copy));
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  geometry.computeVertexNormals();
  const edges = new BufferGeometry();
  edges.setAttribute("position", new BufferAttribute(points, 3));
  edges.setIndex(new BufferAttribute(indices(mesh.edges, mesh.wide), 1));
  return { geometry, edges, points, triangles, starts };
}

const matrixOf = (T) => new Matrix4().set(...T, 0, 0, 0, 1);

export class View {
  constructor(canvas, mechanism, changed) {
    this.canvas = canvas;
    this.mechanism = mechanism;
    this.changed = changed; // told after each frame: labels follow
    this.renderer = new WebGLRenderer({ canvas, antialias: false, alpha: true, preserveDrawingBuffer: false });
    this.renderer.localClippingEnabled = true;
    this.ratio = Math.min(window.devicePixelRatio, 2);
    this.renderer.setPixelRatio(this.ratio);
    this.scene = new Scene();
    this.perspective = new PerspectiveCamera(FIELD, 1, 1, 1e5);
    this.parallel = new OrthographicCamera();
    for (const camera of [this.perspective, this.parallel]) {
      camera.up.set(0, 0, 1);
      camera.layers.enable(MARKS);
    }
    this.camera = this.perspective;
    this.shared = sharedLook();
    this.planes = [];
    this.sections = { x: null, y: null, z: null };
    this.explosion = 0;
    this.focused = null;
    this.shifted = { parts: new Set(), offset: [0, 0, 0] };
    this.hovered = this.selected = -1;
    this.frames = 0;
    this.level = 2; // index in SCALES; the first frame of full quality tells which one this machine can draw
    this.interval = 0; // ms between frames, smoothed
    this.settled = this.busy = false; // busy: something plays or is dragged, so that frames follow each other
    this.#buildParts();
    this.#buildJoints();
    this.#buildOverlaps();
    this.markers = new Group();
    this.scene.add(this.markers);
    this.occlusion = new Occlusion();
    this.copy = new Copy();
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.ask());
    this.controls.addEventListener("start", () => (this.busy = true));
    this.controls.addEventListener("end", () => (this.busy = false));
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  #buildParts() {
    const { meshes, parts } = this.mechanism.model;
    this.meshes = meshes.map(geometryOf);
    this.groups = parts.map((part, index) => {
      const group = new Group();
      group.matrixAutoUpdate = false;
      group.name = part.name;
      const { r, g, b } = new Color(part.color);
      const line = new LineBasicMaterial({ color: 0.2126 * r + 0.7152 * g + 0.0722 * b < 0.03 ? CHALK : INK, transparent: true, opacity: EDGE });
      group.userData = { line, materials: [] };
      for (const shape of part.shapes) {
        const { geometry, edges } = this.meshes[shape.mesh];
        const material = lookOf(shape.color ?? part.color, part.finish, this.shared, geometry);
        refreshLook(material, { faded: false, opacity: 1, cutting: false });
        const surface = new Mesh(geometry, material);
        const outline = new LineSegments(edges, line);
        outline.layers.set(MARKS);
        for (const object of [surface, outline]) {
          object.matrixAutoUpdate = false;
          object.matrix.copy(matrixOf(fromPose(shape.pose)));
          group.add(object);
        }
        surface.userData = { part: index, mesh: shape.mesh };
        group.userData.materials.push(material);
      }
      this.scene.add(group);
      return group;
    });
  }

  #buildJoints() {
    this.axes = new Group();
    this.axes.visible = false;
    this.triads = this.mechanism.joints.map((joint) => {
      const group = new Group();
      group.matrixAutoUpdate = false;
      AXES.forEach((color, k) => {
        const end = [0, 0, 0];
        end[k] = 0.5;
        group.add(this.#line([[0, 0, 0], end], color));
      });
      if (joint.type !== "fixed") {
        group.add(this.#line([[0, 0, -0.8], [0, 0, 1]], JOINT));
        const head = new Mesh(new ConeGeometry(0.05, 0.18, 12), new MeshBasicMaterial({ color: JOINT, depthTest: false, transparent: true }));
        head.rotation.x = Math.PI / 2;
        head.position.z = 1;
        group.add(head);
      }
      group.traverse((object) => {
        object.renderOrder = 5;
        object.layers.set(MARKS);
      });
      this.axes.add(group);
      return group;
    });
    this.scene.add(this.axes);
  }

  // Where parts overlap: red, over everything, in the pose in which it was found.
  #buildOverlaps() {
    this.overlaps = (this.mechanism.model.overlaps ?? []).map((overlap) => {
      const { geometry } = geometryOf(overlap.mesh);
      const solid = new Mesh(geometry, new MeshBasicMaterial({ color: MARK, depthTest: false, transparent: true, opacity: 0.85, side: DoubleSide }));
      solid.layers.set(MARKS);
      solid.renderOrder = 4;
      solid.visible = false;
      this.scene.add(solid);
      return { ...overlap, solid };
    });
  }

  #line(points, color) {
    const geometry = new BufferGeometry().setFromPoints(points.map((point) => new Vector3(...point)));
    const line = new LineSegments(geometry, new LineBasicMaterial({ color, depthTest: false, transparent: true }));
    line.layers.set(MARKS);
    return line;
  }

  // By how much each part is moved from its place when exploded: out of the part that carries it, with all that it carries.
  #offsets(poses) {
    const { parts, tree } = this.mechanism.model;
    const offsets = parts.map(() => [0, 0, 0]);
    for (const { from, to } of this.explosion ? tree : []) {
      const way = parts[to].explode, T = poses[from];
      for (let k = 0; k < 3; k++) {
        offsets[to][k] = offsets[from][k] + this.explosion * (T[4 * k] * way[0] + T[4 * k + 1] * way[1] + T[4 * k + 2] * way[2]);
      }
    }
    for (const part of this.shifted.parts) for (let k = 0; k < 3; k++) offsets[part][k] += this.shifted.offset[k];
    return offsets;
  }

  // Move parts away from their place, as on their way into an assembly, and light them up; no parts: everything is in place.
  shift(parts, offset) {
    this.shifted = { parts: new Set(parts), offset };
    this.#glow();
    this.place(this.poses);
  }

  // Look at some parts as they are placed, and at others that are moved by an offset, from where the camera is.
  frame(parts, moved, offset) {
    const boxes = this.groups.map((group) => new Box3().expandByObject(group));
    const box = new Box3(), way = this.camera.position.clone().sub(this.controls.target).normalize();
    for (const part of [...parts, ...moved]) box.union(boxes[part]);
    for (const part of moved) box.union(boxes[part].translate(new Vector3(...offset)));
    const { center, radius } = box.getBoundingSphere(new Sphere());
    this.#stand(center, way, (Math.max(radius, 0.02 * this.size) * 1.15) / Math.sin((FIELD * Math.PI) / 360) / Math.min(1, this.perspective.aspect));
  }

  // Put every part where it belongs.
  place(poses) {
    this.poses = poses;
    const offsets = this.#offsets(poses);
    poses.forEach((T, index) => {
      const group = this.groups[index];
      group.matrix.copy(matrixOf(T));
      for (let k = 0; k < 3; k++) group.matrix.elements[12 + k] += offsets[index][k];
      group.matrixWorldNeedsUpdate = true;
    });
    const scale = new Matrix4().makeScale(this.size * 0.11, this.size * 0.11, this.size * 0.11);
    this.mechanism.joints.forEach((joint, index) => {
      this.triads[index].matrix.copy(matrixOf(multiply(poses[joint.parent], joint.Cp))).multiply(scale);
      for (let k = 0; k < 3; k++) this.triads[index].matrix.elements[12 + k] += offsets[joint.parent][k];
      this.triads[index].matrixWorldNeedsUpdate = true;
    });
    this.stale = true;
    this.ask();
  }

  // Show the overlaps that were found in the present pose.
  showOverlaps(here) {
    for (const overlap of this.overlaps) overlap.solid.visible = !this.explosion && here(overlap.pose);
    this.ask();
  }

  // Measure the model at rest: its middle and its size.
  measure(poses) {
    this.size = 1;
    this.place(poses);
    this.scene.updateMatrixWorld(true);
    const box = new Box3();
    this.atRest = poses;
    this.partBoxes = this.groups.map((group) => new Box3().expandByObject(group)).filter((own, index) => !own.isEmpty() || own.set(new Vector3(...poses[index].filter((_, k) => k % 4 === 3)), new Vector3(...poses[index].filter((_, k) => k % 4 === 3))));
    for (const group of this.groups) box.expandByObject(group);
    if (box.isEmpty()) box.set(new Vector3(-50, -50, -50), new Vector3(50, 50, 50));
    this.box = box;
    this.sphere = box.getBoundingSphere(new Sphere());
    this.size = this.sphere.radius * 2;
    this.middle = box.getCenter(new Vector3());
    this.explosion = 1;
    this.farthest = Math.max(0, ...this.#offsets(poses).map((offset) => Math.hypot(...offset)));
    this.explosion = 0;
    this.shadow = new GroundShadow(this.scene, box, this.size);
    this.place(poses);
  }

  // Pull parts out of each other; at 1 none is inside another. The camera steps back to keep them in sight.
  explode(amount) {
    const way = this.camera.position.clone().sub(this.controls.target).normalize(), before = this.#framed(way);
    this.explosion = amount;
    this.zoom(this.#framed(way) / before);
    this.place(this.poses);
  }

  // How far from the middle anything may lie while the model rests.
  #reach() {
    return this.sphere.radius + this.explosion * this.farthest;
  }

  look(name) {
    const way = new Vector3(...DIRECTIONS[name]).normalize();
    this.#stand(this.middle, way, this.#framed(way));
  }

  // Look at a place of the present picture from where the camera is.
  fly(center, radius) {
    const way = this.camera.position.clone().sub(this.controls.target).normalize();
    this.#stand(center, way, (Math.max(radius * 3, 0.06 * this.size) * 1.08) / Math.sin((FIELD * Math.PI) / 360) / Math.min(1, this.perspective.aspect));
  }

  // The distance from which the box of the model fills the picture, with room for the tools at its edges.
  #framed(way) {
    const right = new Vector3(0, 0, 1).cross(way).normalize(), up = way.clone().cross(right);
    const half = this.#halfSize();
    const slope = Math.tan((FIELD * Math.PI) / 360), tall = Math.min(FILLED, Math.max(0.5, 1 - TOOLS / this.canvas.clientHeight));
    let distance = 0;
    for (let k = 0; k < 8; k++) {
      const corner = new Vector3(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z);
      const least = Math.max(Math.abs(corner.dot(right)) / this.perspective.aspect / FILLED, Math.abs(corner.dot(up)) / tall) / slope;
      distance = Math.max(distance, least + corner.dot(way));
    }
    return distance;
  }

  // Half the size of a box around the model's middle that holds every part at rest, exploded as it is.
  #halfSize() {
    const half = this.box.getSize(new Vector3()).multiplyScalar(0.5);
    if (!this.explosion) return half;
    const offsets = this.#offsets(this.atRest);
    this.partBoxes.forEach(({ min, max }, index) => {
      for (let k = 0; k < 3; k++) {
        const middle = this.middle.getComponent(k), off = offsets[index][k];
        half.setComponent(k, Math.max(half.getComponent(k), max.getComponent(k) + off - middle, middle - min.getComponent(k) - off));
      }
    });
    return half;
  }

  #stand(center, way, distance) {
    this.controls.target.copy(center);
    this.distance = distance;
    this.camera.position.copy(center).addScaledVector(way, this.distance);
    this.parallel.zoom = 1;
    this.#lens();
    this.controls.update();
    this.camera.updateMatrixWorld();
    this.ask();
  }

  // Parallel rays, or rays from a point; the model keeps its size on the screen.
  project(parallel) {
    if (parallel === (this.camera === this.parallel)) return;
    const from = this.camera, to = parallel ? this.parallel : this.perspective;
    const way = from.position.clone().sub(this.controls.target);
    if (parallel) {
      this.distance = way.length();
      this.parallel.zoom = 1;
    } else way.setLength(this.distance / this.parallel.zoom);
    to.position.copy(this.controls.target).add(way);
    this.camera = this.controls.object = to;
    this.shared.flat_view.value = parallel;
    this.#lens();
    this.controls.update();
    this.camera.updateMatrixWorld();
    this.ask();
  }

  // What the camera sees of the way before it: near and far follow the model.
  #lens() {
    const away = this.camera.position.distanceTo(this.sphere.center), reach = 3 * this.#reach();
    const aspect = this.perspective.aspect;
    if (this.camera === this.parallel) {
      const half = this.distance * Math.tan((FIELD * Math.PI) / 360);
      Object.assign(this.parallel, { left: -half * aspect, right: half * aspect, top: half, bottom: -half, near: away - 2 * reach, far: away + 2 * reach });
    } else {
      this.perspective.near = Math.max(away - reach, away / 400, this.size / 2000);
      this.perspective.far = away + 2 * reach;
    }
    this.camera.updateProjectionMatrix();
  }

  turn(across, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const radius = offset.length();
    const azimuth = Math.atan2(offset.y, offset.x) + across;
    const height = Math.min(Math.max(Math.asin(offset.z / radius) + up, -1.55), 1.55);
    offset.set(Math.cos(azimuth) * Math.cos(height), Math.sin(azimuth) * Math.cos(height), Math.sin(height)).multiplyScalar(radius);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.camera.updateMatrixWorld();
    this.ask();
  }

  zoom(factor) {
    if (this.camera === this.parallel) {
      this.parallel.zoom /= factor;
      this.#lens();
    } else this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.camera.updateMatrixWorld();
    this.ask();
  }

  // Cut by up to three planes: each {share of the box, other side} or null.
  section(sections) {
    this.sections = sections;
    this.planes = Object.entries(sections).filter(([, cut]) => cut).map(([name, { share, flipped }]) => {
      const axis = "xyz".indexOf(name), sign = (name === "y") === !flipped ? 1 : -1; // the half before the first view goes
      const at = this.box.min.getComponent(axis) + share * (this.box.max.getComponent(axis) - this.box.min.getComponent(axis));
      return new Plane(new Vector3().setComponent(axis, sign), -sign * at);
    });
    for (const { userData } of this.groups) {
      userData.line.clippingPlanes = this.planes;
      for (const material of userData.materials) material.clippingPlanes = this.planes; // our shader cuts by itself
    }
    this.#refresh();
    this.stale = true;
  }

  get cutting() {
    return this.planes.length > 0;
  }

  show(index, visible) {
    this.groups[index].visible = visible;
    this.stale = true;
    this.ask();
  }

  // Fade all parts but these; none fades nothing.
  focus(parts) {
    this.focused = parts?.length ? new Set(parts) : null;
    this.#refresh();
  }

  #faded(index) {
    return this.focused !== null && !this.focused.has(index);
  }

  #refresh() {
    this.groups.forEach((group, index) => {
      const faded = this.#faded(index);
      for (const material of group.userData.materials) refreshLook(material, { faded, opacity: FADED, cutting: this.cutting });
      group.userData.edge = faded ? 0.15 : EDGE;
    });
    this.ask();
  }

  // Light up the part under the pointer, and the selected one more; -1 for none.
  hover(part) {
    if (part === this.hovered) return;
    this.hovered = part;
    this.#glow();
  }

  mark_part(part) {
    this.selected = part;
    this.#glow();
  }

  #glow() {
    this.groups.forEach((group, index) => {
      const strength = index === this.selected || this.shifted.parts.has(index) ? 0.4 : index === this.hovered ? 0.14 : 0;
      for (const material of group.userData.materials) material.emissive.setHex(JOINT).multiplyScalar(strength);
    });
    this.ask();
  }

  // The matrix of a part in given poses, exploded as it is drawn.
  placed(index, poses) {
    const matrix = matrixOf(poses[index]), offset = this.#offsets(poses)[index];
    for (let k = 0; k < 3; k++) matrix.elements[12 + k] += offset[k];
    return matrix;
  }

  // What is under the pointer: exactly there, or a corner, an edge or a face of the part.
  pick(clientX, clientY, { exact = false } = {}) {
    const bounds = this.canvas.getBoundingClientRect();
    this.camera.updateMatrixWorld();
    const surfaces = this.groups.filter((group, index) => group.visible && !this.#faded(index)).flatMap((group) => group.children.filter((o) => o.userData.part !== undefined));
    const ray = new Raycaster();
    ray.layers.set(PARTS);
    const through = (x, y) => {
      const at = new Vector2(((x - bounds.left) / bounds.width) * 2 - 1, 1 - ((y - bounds.top) / bounds.height) * 2);
      ray.setFromCamera(at, this.camera);
      return [at, ray.intersectObjects(surfaces, false).find(({ point }) => this.planes.every((plane) => plane.distanceToPoint(point) >= 0))];
    };
    let [at, hit] = through(clientX, clientY);
    // Just beside the outline: what is nearest there.
    for (let turn = 0; !hit && !exact && turn < 8; turn++) [, hit] = through(clientX + BESIDE * Math.cos((turn * Math.PI) / 4), clientY + BESIDE * Math.sin((turn * Math.PI) / 4));
    if (!hit) return null;
    const { part, mesh } = hit.object.userData;
    const group = this.groups[part];
    if (exact) return { part, local: group.worldToLocal(hit.point.clone()) };
    const pixels = (point) => {
      const seen = point.clone().applyMatrix4(hit.object.matrixWorld).project(this.camera);
      return [(seen.x - at.x) * bounds.width / 2, (seen.y - at.y) * bounds.height / 2];
    };
    const feature = featureAt(this.meshes[mesh], hit.faceIndex, hit.object.worldToLocal(hit.point.clone()), pixels, { corner: NEAR_CORNER, edge: NEAR_EDGE });
    const moved = (point) => point.applyMatrix4(hit.object.matrix); // into the part's frame
    moved(feature.local);
    if (feature.direction) feature.direction.transformDirection(hit.object.matrix);
    return { part, ...feature };
  }

  worldOf({ part, local }) {
    this.groups[part].updateMatrixWorld(true);
    return this.groups[part].localToWorld(local.clone());
  }

  directionOf({ part, direction }) {
    this.groups[part].updateMatrixWorld(true);
    return direction.clone().transformDirection(this.groups[part].matrixWorld);
  }

  // Dots, and lines between two points each.
  mark(points, lines = []) {
    this.markers.clear();
    const radius = this.size * 0.004;
    for (const point of points) {
      const dot = new Mesh(new SphereGeometry(radius, 12, 8), new MeshBasicMaterial({ color: MARK, depthTest: false, transparent: true }));
      dot.position.copy(point);
      dot.layers.set(MARKS);
      this.markers.add(dot);
    }
    for (const line of lines) this.markers.add(this.#line(line.map((point) => point.toArray()), MARK));
    this.markers.traverse((object) => (object.renderOrder = 6));
    this.ask();
  }

  // Where a point of space is seen, in pixels of the canvas.
  screen(point) {
    const seen = point.clone().project(this.camera);
    return [((seen.x + 1) / 2) * this.canvas.clientWidth, ((1 - seen.y) / 2) * this.canvas.clientHeight, seen.z < 1];
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.perspective.aspect = width / height;
    if (this.sphere) this.#lens();
    this.draw();
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now) => this.#moving(now));
  }

  // A frame in motion. Frames that follow each other closely tell how many pixels the machine can draw.
  #moving(now) {
    const since = now - (this.before ?? 0);
    this.before = now;
    if (this.busy || since < 250) {
      this.interval = this.interval ? 0.7 * this.interval + 0.3 * since : since;
      this.steady = (this.steady ?? 0) + 1;
      if (this.steady > 2 && this.interval > SLOW && this.level < SCALES.length - 1) this.#rescale(this.level + (this.interval > 2 * SLOW ? 2 : 1));
      else if (this.steady > 20 && this.interval < QUICK && this.level > 0) this.#rescale(this.level - 1);
    } else this.steady = this.interval = 0;
    this.draw();
  }

  #rescale(level) {
    this.level = Math.min(level, SCALES.length - 1);
    this.steady = this.interval = 0;
  }

  #resolution(scale) {
    if (this.renderer.getPixelRatio() !== this.ratio * scale) this.renderer.setPixelRatio(this.ratio * scale);
    this.shared.detail.value = scale;
    this.shared.hatch.value = [1.2 * this.ratio * scale, 7 * this.ratio * scale];
    for (const { userData } of this.groups) userData.line.opacity = (userData.edge ?? EDGE) * (0.3 + 0.7 * scale);
  }

  draw() {
    this.asked = this.settled = false;
    this.#resolution(SCALES[this.level]);
    this.#render({ shadow: this.frames % (this.level ? 6 : 3) === 2 }); // not in the first frame
    this.frames += 1;
    this.changed();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => requestAnimationFrame(() => this.asked || this.finish()), STILL);
  }

  // The frame of full quality.
  finish({ fine = true } = {}) {
    const started = performance.now();
    this.#resolution(1);
    this.#render({ shadow: true, fine, smooth: true });
    if (!this.tried) {
      this.renderer.getContext().finish();
      this.tried = true;
      if (performance.now() - started < 2 * QUICK) this.level = 0;
    }
    this.settled = true;
  }

  // Hide what casts no shadow; the function that is returned shows it again.
  #onlySolid = () => {
    const hidden = this.groups.filter((group, index) => group.visible && (this.#faded(index) || group.userData.materials.some((material) => material.clear)));
    for (const group of hidden) group.visible = false;
    return () => hidden.forEach((group) => (group.visible = true));
  };

  #render({ shadow = false, fine = false, smooth = this.level === 0 } = {}) {
    this.#lens();
    this.camera.updateMatrixWorld();
    const { planes, cuts, up } = this.shared;
    up.value.set(0, 0, 1).transformDirection(this.camera.matrixWorldInverse);
    this.shared.middle.value.copy(this.middle).applyMatrix4(this.camera.matrixWorldInverse);
    this.shared.size.value = this.size;
    cuts.value = this.planes.length;
    this.planes.forEach((plane, k) => {
      const seen = plane.clone().applyMatrix4(this.camera.matrixWorldInverse);
      planes.value[k].set(...seen.normal.toArray(), seen.constant);
    });
    if (this.shadow) {
      const before = this.camera.position.z > this.shadow.level;
      this.shadow.ground.visible = before && !this.explosion && !this.cutting;
      this.shadow.ground.material.uniforms.strength.value = this.focused ? 0.3 : 1;
      if (this.shadow.ground.visible && this.stale && shadow) {
        this.shadow.draw(this.renderer, this.scene, this.#onlySolid);
        this.stale = false;
      }
    }
    if (smooth) {
      // Smooth edges by four samples for each pixel. Frames in few pixels go without: they cost a third.
      const { x: width, y: height } = this.renderer.getDrawingBufferSize(new Vector2());
      if (this.smooth?.width !== width || this.smooth?.height !== height) {
        this.smooth?.dispose();
        this.smooth = new WebGLRenderTarget(width, height, { samples: 4 });
      }
      this.renderer.setRenderTarget(this.smooth);
      this.renderer.clear();
      this.renderer.render(this.scene, this.camera);
      this.copy.draw(this.renderer, this.smooth.texture);
    } else {
      this.renderer.setRenderTarget(null);
      this.renderer.render(this.scene, this.camera);
    }
    if (fine && !this.cutting) this.occlusion.draw(this.renderer, this.scene, this.camera, { reach: 0.07 * this.size, planes: this.planes, show: this.#onlySolid });
  }

  // Draw in full quality, or without ambient occlusion for films, and at once hand the picture to a function: it is gone after that.
  // Width in pixels, or as on the screen.
  picture(paint, { width = null, fine = true } = {}) {
    const { clientWidth, clientHeight } = this.canvas;
    const ratio = this.ratio;
    if (width) this.ratio = width / clientWidth;
    this.finish({ fine });
    const made = paint(this.canvas, Math.round(clientWidth * this.ratio), Math.round(clientHeight * this.ratio));
    this.ratio = ratio;
    this.ask();
    return made;
  }
}
