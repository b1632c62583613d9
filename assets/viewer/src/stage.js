// One glTF file with its own camera, lights, animation and readings. glTF: metres, Y up.
import {
  AnimationMixer, Box3, Color, DirectionalLight, DoubleSide, Float32BufferAttribute, Group, HemisphereLight, LoopOnce, NeutralToneMapping,
  PerspectiveCamera, PMREMGenerator, Raycaster, Scene, Spherical, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { colourAt } from './data.js';
import { Marks } from './measure.js';
import { Section } from './section.js';

/** From the front, the right and above: the way an operator looks through the door. */
const lookFrom = new Vector3(0.62, 0.55, 1).normalize();

/** Standard views: from where the eye looks, Y up. */
export const views = {
  'Operator': lookFrom, 'Front': new Vector3(0, 0, 1), 'Back': new Vector3(0, 0, -1), 'Left': new Vector3(-1, 0, 0),
  'Right': new Vector3(1, 0, 0), 'Top': new Vector3(0, 1, 0.001).normalize(), 'Bottom': new Vector3(0, -1, 0.001).normalize(),
};

/** What is drawn by what a node says it is; a hidden object goes to a layer that nothing looks at. */
export const roles = { part: 'Part', stock: 'Stock', design: 'Design', fixture: 'Fixtures', tool: 'Tool', machine: 'Machine', finding: 'Findings' };
const hiddenLayer = 31;

/** Air around the model. */
const margin = 1.05;

/** Machined parts shine, but the colours of deviation must stay readable against their legend. */
const partRoughness = 0.75;

export function createRenderer(canvas) {
  const renderer = new WebGLRenderer({ canvas, antialias: true });
  renderer.localClippingEnabled = true;
  renderer.toneMapping = NeutralToneMapping;  // keeps hues, so that colours agree with the legend
  return renderer;
}

/** Without a graphics card, where the light of a room takes seconds to be made. */
function drawsBySoftware(renderer) {
  const gl = renderer.getContext(), info = gl.getExtension('WEBGL_debug_renderer_info');
  return /swiftshader|llvmpipe|software|basic render/i.test(info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '');
}

let environment = null;
/** The light of a room, or of a plain sky. */
function light(scene, renderer) {
  if (drawsBySoftware(renderer)) {
    scene.add(new HemisphereLight(0xffffff, 0x9aa0a8, 2.6));
    return;
  }
  if (!environment) {
    const generator = new PMREMGenerator(renderer);
    environment = generator.fromScene(new RoomEnvironment(), 0.04).texture;
    generator.dispose();
  }
  scene.environment = environment;
  scene.environmentIntensity = 0.55;
}

/** A mesh of several primitives, or of quantised numbers, is a child without a name. */
const nodeName = (object) => object.name || object.parent?.name || '';

/** Hidden stages and tools are scaled to nothing. */
const isScaled = (object) => object.matrixWorld.determinant() !== 0;

function roleOf(object) {
  for (let at = object; at; at = at.parent) if (at.userData.role) return at.userData.role;
  return '';
}

/** The attribute that carries the deviation, whatever unit its name adds. */
const deviationOf = (geometry) =>
  Object.keys(geometry.attributes).find((name) => name.startsWith('_deviation'));

/** By vertex, um; null: this mesh is not measured. */
function deviationReader(mesh) {
  const name = deviationOf(mesh.geometry);
  if (!name) return null;
  const values = mesh.geometry.attributes[name], unit = mesh.geometry.userData.deviation_um_per_unit ?? 1;
  return (vertex) => unit * values.getX(vertex);
}

/** From blue over green to yellow: Viridis at five places. */
const ramp = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]].map((c) => c.map((v) => v / 255));
function rampAt(share) {
  const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1), below = Math.min(Math.floor(at), ramp.length - 2);
  return ramp[below].map((channel, k) => channel + (at - below) * (ramp[below + 1][k] - channel));
}

export class Stage {
  static async read(bytes, renderer, canvas, onChange, scale) {
    const gltf = await new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).parseAsync(bytes, '');
    return new Stage(gltf, renderer, canvas, onChange, scale);
  }

  constructor(gltf, renderer, canvas, onChange, scale) {
    this.scene = new Scene();
    this.scene.add(gltf.scene);
    light(this.scene, renderer);
    this.camera = new PerspectiveCamera(32, 1, 0.01, 100);
    const key = new DirectionalLight(0xffffff, 1.9);
    key.position.set(-0.8, 1.2, 0.9);
    this.scene.add(key, this.camera);
    this.scene.updateMatrixWorld(true);
    this.sortObjects(gltf.scene);
    this.startAnimation(gltf);
    this.base = gltf.scene.children[0] ?? gltf.scene;
    this.work = this.workNode();
    this.marks = new Marks(this.work);
    const solid = this.meshes.filter((mesh) => ['part', 'stock', 'design'].includes(roleOf(mesh)));
    this.section = new Section(this.work, solid, deviationReader, scale);
    if (scale) this.setScale(scale);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', onChange);
    this.frame();
  }

  sortObjects(root) {
    this.lines = [];
    this.coloured = [];
    this.probed = [];
    this.meshes = [];
    this.byRole = new Map();
    this.coloursOn = true;
    this.path = null;
    this.tools = [];
    root.traverse((object) => {
      if (object.userData.role === 'tool' && object.name.startsWith('cutter')) this.tools.push(object);
      if (object.isLine) {
        if (object.geometry.attributes._time_s) this.path = object;
        else this.lines.push(object);
      }
      if (!object.isMesh) return;
      this.meshes.push(object);
      const role = roleOf(object);
      if (role) this.byRole.set(role, [...(this.byRole.get(role) ?? []), object]);
      if (!deviationOf(object.geometry)) return;
      this.probed.push(object);
      object.material.roughness = Math.max(object.material.roughness, partRoughness);
      this.coloured.push(object);
    });
    for (const object of this.lines) object.visible = false;  // the part first; a switch shows them
    for (const mesh of this.byRole.get('design') ?? []) {
      Object.assign(mesh.material, { transparent: true, opacity: 0.55, depthWrite: false, side: DoubleSide });
      mesh.layers.set(hiddenLayer);
    }
    if (this.path) this.path.visible = false;
  }

  /**
   * The frame in which the program counts, mm: that of the stock, or of the whole file. A node of its own, for the
   * stock's stages are scaled to nothing while they are hidden.
   */
  workNode() {
    const [mesh] = this.byRole.get('stock') ?? [];
    let stock = mesh;
    while (stock && !stock.userData.role) stock = stock.parent;
    if (!stock) return this.base;
    const work = new Group();
    work.position.copy(stock.position);
    work.quaternion.copy(stock.quaternion);
    stock.parent.add(work);
    work.updateWorldMatrix(true, false);
    return work;
  }

  /** Where the tool that is in the spindle ends, work frame, mm; null: no tool. */
  toolTip() {
    this.scene.updateMatrixWorld(true);
    const shown = this.tools.find(isScaled);
    return shown ? this.toWork(shown.getWorldPosition(new Vector3())) : null;
  }

  /** Name of the stage of the stock that is shown; '': none. */
  stockShown() {
    const shown = (this.byRole.get('stock') ?? []).find(isScaled);
    return shown ? nodeName(shown) : '';
  }

  roles() { return Object.keys(roles).filter((role) => this.byRole.has(role)); }
  roleShown(role) { return (this.byRole.get(role) ?? []).some((mesh) => mesh.layers.isEnabled(0)); }
  setRole(role, on) {
    for (const mesh of this.byRole.get(role) ?? []) mesh.layers.set(on ? 0 : hiddenLayer);
  }

  /** Colours the measured part by these limits. */
  setScale(scale) {
    this.scale = scale;
    const colour = new Color();
    for (const mesh of this.coloured) {
      const read = deviationReader(mesh), { count } = mesh.geometry.attributes.position, values = new Float32Array(3 * count);
      for (let i = 0; i < count; ++i) {
        colour.setRGB(...colourAt(scale, read(i)), 'srgb').toArray(values, 3 * i);
      }
      mesh.geometry.setAttribute('color', new Float32BufferAttribute(values, 3));
      mesh.material.vertexColors = this.coloursOn;
      mesh.material.color.set(this.coloursOn ? 0xffffff : 0xaeb4bb);
      mesh.material.needsUpdate = true;
    }
  }

  /** 'off', 'tool' or 'feed'; returns the range of feeds, mm/min. */
  colourPath(by) {
    const { path } = this;
    if (!path) return null;
    path.visible = by !== 'off';
    const { attributes } = path.geometry;
    this.toolColours ??= attributes.color;
    if (by !== 'feed') {
      if (this.toolColours) path.geometry.setAttribute('color', this.toolColours);
      return null;
    }
    let low = Infinity, high = 0;
    const feed = attributes._feed_mm_min, rapid = attributes._rapid, values = new Float32Array(3 * feed.count), colour = new Color();
    for (let i = 0; i < feed.count; ++i) {
      if (rapid.getX(i)) continue;
      low = Math.min(low, feed.getX(i));
      high = Math.max(high, feed.getX(i));
    }
    for (let i = 0; i < feed.count; ++i) {
      const rgb = rapid.getX(i) ? [0.47, 0.5, 0.54] : rampAt((feed.getX(i) - low) / Math.max(high - low, 1e-9));
      colour.setRGB(...rgb, 'srgb').toArray(values, 3 * i);
    }
    path.geometry.setAttribute('color', new Float32BufferAttribute(values, 3));
    return { low, high };
  }

  startAnimation(gltf) {
    this.duration = Math.max(0, ...gltf.animations.map((clip) => clip.duration));
    this.time = 0;
    this.mixer = new AnimationMixer(gltf.scene);
    this.actions = gltf.animations.map((clip) => this.mixer.clipAction(clip));
    for (const action of this.actions) {
      action.setLoop(LoopOnce);
      action.clampWhenFinished = true;
      action.play();
    }
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.duration);
    // A finished action stays paused for good, also when the time goes back: wake it first.
    for (const action of this.actions) action.paused = false;
    this.mixer.setTime(this.time);
  }

  /** Line objects by the name of the node that holds them, and by colour where one node holds several. */
  lineGroups() {
    const groups = new Map();
    for (const line of this.lines) {
      const name = (line.name || line.parent?.name || 'lines').replace(/_\d+$/, '');  // the loader's numbers
      const colour = `#${line.material.color.getHexString()}`;
      const key = `${name} ${colour}`;
      if (!groups.has(key)) groups.set(key, { name, colour, objects: [] });
      groups.get(key).objects.push(line);
    }
    return [...groups.values()];
  }

  setColours(on) {
    this.coloursOn = on;
    if (this.scale) this.setScale(this.scale);
  }

  /** A point of the work frame, mm, in the world, m. */
  toWorld(point) { return this.work.localToWorld(point.clone()); }
  toWork(point) { return this.work.worldToLocal(point.clone()); }

  /** Looks at a place of the work frame, or of the machine's, from where the eye is, from near. */
  visit(point, inMachine = false) {
    this.scene.updateMatrixWorld(true);
    const target = inMachine ? this.base.localToWorld(point.clone()) : this.toWorld(point);
    const from = this.camera.position.clone().sub(this.controls.target).normalize();
    const distance = 0.6 * this.extent(this.workMeshes());
    this.camera.position.copy(target).addScaledVector(from, distance);
    this.controls.target.copy(target);
    this.controls.update();
    this.marks.show([{ at: this.toWork(target) }]);
  }

  workMeshes() {
    const meshes = [...(this.byRole.get('part') ?? []), ...(this.byRole.get('stock') ?? [])];
    return meshes.length ? meshes : this.meshes;
  }

  boxOf(meshes) {
    const box = new Box3();
    for (const mesh of meshes) {
      mesh.geometry.boundingBox ?? mesh.geometry.computeBoundingBox();
      const own = mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrixWorld);
      if (own.getSize(new Vector3()).length() > 0) box.union(own);
    }
    return box;
  }

  extent(meshes) { return Math.max(this.boxOf(meshes).getSize(new Vector3()).length(), 1e-6); }
  /** The stock as it stands now. */
  zoomToWork() {
    this.scene.updateMatrixWorld(true);
    this.frame(this.boxOf(this.workMeshes()));
  }

  /** Turns (and shifts, and goes nearer) by the keys; false: not one of them. */
  key(event) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const zoom = { '+': 1 / 1.15, '=': 1 / 1.15, '-': 1.15 }[event.key];
    const offset = this.camera.position.clone().sub(this.controls.target);
    if (zoom) offset.multiplyScalar(zoom);
    else if (step && event.shiftKey) {
      const by = 0.05 * offset.length();
      const move = new Vector3().setFromMatrixColumn(this.camera.matrix, 0).multiplyScalar(step[0] * by)
        .addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrix, 1), -step[1] * by);
      this.controls.target.add(move);
    } else if (step) {
      const turned = new Spherical().setFromVector3(offset);
      turned.theta += step[0] * 0.09;
      turned.phi += step[1] * 0.09;
      offset.setFromSpherical(turned.makeSafe());
    } else return false;
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    return true;
  }

  /** Puts a box, or the whole model, into the picture, as large as it fits; looked at from `from`. */
  frame(box = this.boxOf(this.meshes), from = lookFrom) {
    const centre = box.getCenter(new Vector3()), half = box.getSize(new Vector3()).multiplyScalar(0.5);
    const radius = Math.max(half.length(), 1e-6);
    const right = new Vector3(0, 1, 0).cross(from).normalize(), up = from.clone().cross(right);
    const rise = Math.tan((this.camera.fov * Math.PI) / 360), run = rise * this.camera.aspect;
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const at = new Vector3(corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z);
      const sideways = Math.max(Math.abs(at.dot(right)) / run, Math.abs(at.dot(up)) / rise);
      distance = Math.max(distance, at.dot(from) + sideways);
    }
    distance *= margin;
    this.camera.position.copy(from).multiplyScalar(distance).add(centre);
    this.camera.near = radius / 200;
    this.camera.far = 4 * distance + 20 * radius + 20 * this.extent(this.meshes);
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(centre);
    this.controls.minDistance = radius / 100;
    this.controls.maxDistance = 3 * distance + 5 * this.extent(this.meshes);
    this.controls.update();
  }

  setAspect(aspect) {
    const first = this.aspect === undefined;
    this.aspect = aspect;
    this.camera.aspect = aspect;
    this.camera.updateProjectionMatrix();
    if (first) this.frame();
  }

  hit(pointer, objects) {
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(pointer.x, pointer.y), this.camera);
    const cut = (found) => (found.object.material.clippingPlanes ?? []).some((plane) => plane.distanceToPoint(found.point) < 0);
    const shown = (found) => found.object.isMesh && found.object.visible && !cut(found);
    return ray.intersectObjects(objects, true).find(shown);
  }

  centreOn(pointer) {
    const found = this.hit(pointer, this.meshes);
    if (!found) return;
    this.controls.target.copy(found.point);
    this.controls.update();
  }

  /** The part under the pointer: place in the work frame, deviation (null: not measured), what lies behind it. */
  pick(pointer) {
    const found = this.hit(pointer, this.workMeshes());
    if (!found) return null;
    const at = this.toWork(found.point), read = deviationReader(found.object);
    const inward = found.face.normal.clone().transformDirection(found.object.matrixWorld).negate();
    const ray = new Raycaster(found.point.clone().addScaledVector(inward, 1e-6), inward);
    const [behind] = ray.intersectObjects(this.workMeshes(), false);
    const end = behind ? this.toWork(behind.point) : null;
    return { at, deviation: read ? this.between(found, read) : null, end, through: end ? end.distanceTo(at) : null };
  }

  between(found, read) {
    const { a, b, c } = found.face, weight = found.barycoord;
    return read(a) * weight.x + read(b) * weight.y + read(c) * weight.z;
  }

  /** The part's deviation under the pointer, um; null beside the part. */
  readDeviation(pointer) {
    const found = this.hit(pointer, this.probed);
    return found ? this.between(found, deviationReader(found.object)) : null;
  }

  /** Number of the finding whose pin is under the pointer; 0: none. */
  pinAt(pointer) {
    const found = this.hit(pointer, this.byRole.get('finding') ?? []);
    for (let at = found?.object; at; at = at.parent) if (at.userData.finding) return at.userData.finding;
    return 0;
  }

  /** The vertex with the least (-1) or the greatest (+1) deviation; null: nothing is measured. */
  extreme(sign) {
    let best = null;
    for (const mesh of this.probed) {
      const read = deviationReader(mesh), { position } = mesh.geometry.attributes;
      for (let i = 0; i < position.count; ++i) {
        if (best && sign * read(i) <= sign * best.deviation) continue;
        best = { deviation: read(i), mesh, vertex: i };
      }
    }
    if (!best) return null;
    const point = new Vector3().fromBufferAttribute(best.mesh.geometry.attributes.position, best.vertex);
    return { deviation: best.deviation, at: this.toWork(best.mesh.localToWorld(point)) };
  }

  render(renderer) {
    renderer.render(this.scene, this.camera);
  }
}
