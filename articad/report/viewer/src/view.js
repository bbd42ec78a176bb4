// What is drawn: one group per part, moved as a whole; frames when something has changed and at no other time.
import {
  AmbientLight, BackSide, Box3, BufferAttribute, BufferGeometry, Color, ConeGeometry, DirectionalLight, DoubleSide, FrontSide,
  Group, HemisphereLight, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial,
  PerspectiveCamera, Plane, Raycaster, Scene, Sphere, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { fromPose, multiply } from "./kinematics.js";

const INK = 0x20242a;
const JOINT = 0x1f8ae0;
const AXES = [0xd33a3a, 0x2a9b48, 0x3a66d8];
const FADED = 0.12; // opacity of parts that a finding is not about
const FIELD = 32; // degrees
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
  return { geometry, edges, points, triangles };
}

const matrixOf = (T) => new Matrix4().set(...T, 0, 0, 0, 1);

export class View {
  constructor(canvas, mechanism, changed) {
    this.canvas = canvas;
    this.mechanism = mechanism;
    this.changed = changed; // told after each frame: labels follow
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: false });
    this.renderer.localClippingEnabled = true;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FIELD, 1, 1, 1e5);
    this.camera.up.set(0, 0, 1);
    const key = new DirectionalLight(0xffffff, 2.0);
    key.position.set(-0.4, 0.6, 1);
    this.camera.add(key);
    this.scene.add(this.camera, new HemisphereLight(0xffffff, 0x9a9488, 1.1), new AmbientLight(0xffffff, 0.35));
    this.plane = new Plane(new Vector3(-1, 0, 0), 0);
    this.cutting = false;
    this.explosion = 0;
    this.focused = null;
    this.hovered = this.selected = -1;
    this.frames = 0;
    this.#buildParts();
    this.#buildJoints();
    this.markers = new Group();
    this.scene.add(this.markers);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.ask());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  #buildParts() {
    const { meshes, parts } = this.mechanism.model;
    this.meshes = meshes.map(geometryOf);
    this.groups = parts.map((part) => {
      const group = new Group();
      group.matrixAutoUpdate = false;
      group.name = part.name;
      const color = new Color(part.color);
      const line = new LineBasicMaterial({ color: INK, transparent: true, opacity: 0.75 });
      group.userData = { line, materials: [], caps: [] };
      for (const shape of part.shapes) {
        const { geometry, edges } = this.meshes[shape.mesh];
        const own = shape.color ? new Color(shape.color) : color;
        const material = new MeshLambertMaterial({ color: own, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
        const surface = new Mesh(geometry, material);
        const cap = new Mesh(geometry, new MeshBasicMaterial({ color: own.clone().lerp(new Color(0xffffff), 0.35), side: BackSide }));
        cap.visible = false;
        const outline = new LineSegments(edges, line);
        for (const object of [surface, cap, outline]) {
          object.matrixAutoUpdate = false;
          object.matrix.copy(matrixOf(fromPose(shape.pose)));
          group.add(object);
        }
        surface.userData.part = parts.indexOf(part);
        group.userData.materials.push(material);
        group.userData.caps.push(cap);
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
      group.traverse((object) => (object.renderOrder = 5));
      this.axes.add(group);
      return group;
    });
    this.scene.add(this.axes);
  }

  #line(points, color) {
    const geometry = new BufferGeometry().setFromPoints(points.map((point) => new Vector3(...point)));
    return new LineSegments(geometry, new LineBasicMaterial({ color, depthTest: false, transparent: true }));
  }

  // Put every part where it belongs.
  place(poses) {
    this.poses = poses;
    const middle = this.middle ?? new Vector3();
    poses.forEach((T, index) => {
      const group = this.groups[index];
      group.matrix.copy(matrixOf(T));
      if (this.explosion && this.outward) {
        const way = this.outward[index];
        for (let k = 0; k < 3; k++) group.matrix.elements[12 + k] += this.explosion * (way[k] - middle.getComponent(k));
      }
      group.matrixWorldNeedsUpdate = true;
    });
    const scale = new Matrix4().makeScale(this.size * 0.11, this.size * 0.11, this.size * 0.11);
    this.mechanism.joints.forEach((joint, index) => {
      this.triads[index].matrix.copy(matrixOf(multiply(poses[joint.parent], joint.Cp))).multiply(scale);
      this.triads[index].matrixWorldNeedsUpdate = true;
    });
    this.ask();
  }

  // Measure the model at rest: its middle, its size, and which way each part goes when exploded.
  measure(poses) {
    this.size = 1;
    this.place(poses);
    this.scene.updateMatrixWorld(true);
    const box = new Box3();
    for (const group of this.groups) box.expandByObject(group);
    if (box.isEmpty()) box.set(new Vector3(-50, -50, -50), new Vector3(50, 50, 50));
    this.box = box;
    this.sphere = box.getBoundingSphere(new Sphere());
    this.size = this.sphere.radius * 2;
    this.middle = box.getCenter(new Vector3());
    this.outward = this.groups.map((group) => {
      const own = new Box3().expandByObject(group);
      return (own.isEmpty() ? this.middle : own.getCenter(new Vector3())).toArray();
    });
    this.farthest = Math.max(0, ...this.outward.map((way) => this.middle.distanceTo(new Vector3(...way))));
    this.place(poses);
  }

  // Move parts away from the middle by so many times their distance from it; the camera steps back to keep them in sight.
  explode(amount) {
    const before = this.#reach();
    this.explosion = amount;
    this.zoom(this.#reach() / before);
    this.place(this.poses);
  }

  // How far from the middle anything may lie while the model rests.
  #reach() {
    return this.sphere.radius + this.explosion * this.farthest;
  }

  look(name) {
    const way = new Vector3(...DIRECTIONS[name]).normalize();
    this.controls.target.copy(this.sphere.center);
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (this.#reach() * 1.08) / Math.sin((FIELD * Math.PI) / 360) / narrow;
    this.camera.position.copy(this.sphere.center).addScaledVector(way, distance);
    this.camera.near = distance / 200;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.ask();
  }

  turn(across, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const radius = offset.length();
    const azimuth = Math.atan2(offset.y, offset.x) + across;
    const height = Math.min(Math.max(Math.asin(offset.z / radius) + up, -1.55), 1.55);
    offset.set(Math.cos(azimuth) * Math.cos(height), Math.sin(azimuth) * Math.cos(height), Math.sin(height)).multiplyScalar(radius);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.ask();
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.ask();
  }

  section(axis, share, flipped) {
    this.cutting = axis >= 0;
    if (this.cutting) {
      const sign = flipped ? 1 : -1;
      const at = this.box.min.getComponent(axis) + share * (this.box.max.getComponent(axis) - this.box.min.getComponent(axis));
      this.plane.normal.set(0, 0, 0).setComponent(axis, sign);
      this.plane.constant = -sign * at;
    }
    const planes = this.cutting ? [this.plane] : [];
    for (const { userData } of this.groups) {
      userData.line.clippingPlanes = planes;
      for (const material of userData.materials) {
        material.clippingPlanes = planes;
        material.side = this.cutting ? FrontSide : DoubleSide;
        material.needsUpdate = true;
      }
      for (const cap of userData.caps) {
        cap.visible = this.cutting;
        cap.material.clippingPlanes = planes;
      }
    }
    this.ask();
  }

  show(index, visible) {
    this.groups[index].visible = visible;
    this.ask();
  }

  // Fade all parts but these; none fades nothing.
  focus(parts) {
    this.focused = parts?.length ? new Set(parts) : null;
    this.groups.forEach((group, index) => {
      const faded = this.focused !== null && !this.focused.has(index);
      for (const material of group.userData.materials) {
        material.transparent = faded;
        material.opacity = faded ? FADED : 1;
        material.depthWrite = !faded;
        material.needsUpdate = true;
      }
      group.userData.line.opacity = faded ? 0.18 : 0.75;
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
      const strength = index === this.selected ? 0.4 : index === this.hovered ? 0.18 : 0;
      for (const material of group.userData.materials) material.emissive.setHex(JOINT).multiplyScalar(strength);
    });
    this.ask();
  }

  // The matrix of a part in given poses, exploded as it is drawn.
  placed(index, poses) {
    const matrix = matrixOf(poses[index]);
    if (this.explosion && this.outward) {
      for (let k = 0; k < 3; k++) matrix.elements[12 + k] += this.explosion * (this.outward[index][k] - this.middle.getComponent(k));
    }
    return matrix;
  }

  // The point of a part under the pointer, at a corner where one is near.
  pick(clientX, clientY, { exact = false } = {}) {
    const bounds = this.canvas.getBoundingClientRect();
    const at = new Vector2(((clientX - bounds.left) / bounds.width) * 2 - 1, 1 - ((clientY - bounds.top) / bounds.height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    const surfaces = this.groups.filter((group) => group.visible).flatMap((group) => group.children.filter((o) => o.userData.part !== undefined));
    const hit = ray.intersectObjects(surfaces, false).find(({ point }) => !this.cutting || this.plane.distanceToPoint(point) >= 0);
    if (!hit) return null;
    const own = this.groups[hit.object.userData.part];
    if (exact) return { part: hit.object.userData.part, local: own.worldToLocal(hit.point.clone()) };
    const corners = [hit.face.a, hit.face.b, hit.face.c].map((corner) =>
      new Vector3().fromBufferAttribute(hit.object.geometry.attributes.position, corner).applyMatrix4(hit.object.matrixWorld));
    const pixels = (point) => {
      const seen = point.clone().project(this.camera);
      return Math.hypot((seen.x - at.x) * bounds.width, (seen.y - at.y) * bounds.height) / 2;
    };
    const nearest = corners.sort((a, b) => pixels(a) - pixels(b))[0];
    const point = pixels(nearest) < 12 ? nearest : hit.point;
    const group = this.groups[hit.object.userData.part];
    return { part: hit.object.userData.part, local: group.worldToLocal(point.clone()) };
  }

  worldOf({ part, local }) {
    this.groups[part].updateMatrixWorld(true);
    return this.groups[part].localToWorld(local.clone());
  }

  mark(points) {
    this.markers.clear();
    if (points.length) {
      const radius = this.size * 0.006;
      for (const point of points) {
        const dot = new Mesh(new ConeGeometry(radius, radius * 2, 8), new MeshBasicMaterial({ color: 0xe5383b, depthTest: false, transparent: true }));
        dot.position.copy(point);
        this.markers.add(dot);
      }
      if (points.length === 2) this.markers.add(this.#line(points.map((point) => point.toArray()), 0xe5383b));
    }
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
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.asked = false;
    this.renderer.render(this.scene, this.camera);
    this.frames += 1;
    this.changed();
  }

  picture() {
    this.renderer.render(this.scene, this.camera); // a picture can only be taken in the moment it is drawn
    return this.canvas.toDataURL("image/png");
  }
}
