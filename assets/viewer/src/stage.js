// One glTF file with its own camera, lights, animation and readings. glTF: metres, Y up.
import {
  AnimationMixer, Box3, DirectionalLight, LoopOnce, NeutralToneMapping, PerspectiveCamera, PMREMGenerator,
  Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

/** From the front, the right and above: the way an operator looks through the door. */
const lookFrom = new Vector3(0.62, 0.55, 1).normalize();

/** Air around the model. */
const margin = 1.05;

/** Machined parts shine, but the colours of deviation must stay readable against their legend. */
const partRoughness = 0.75;

export function createRenderer(canvas) {
  const renderer = new WebGLRenderer({ canvas, antialias: true });
  renderer.toneMapping = NeutralToneMapping;  // keeps hues, so that colours agree with the legend
  return renderer;
}

let environment = null;
function roomEnvironment(renderer) {
  if (!environment) {
    const generator = new PMREMGenerator(renderer);
    environment = generator.fromScene(new RoomEnvironment(), 0.04).texture;
    generator.dispose();
  }
  return environment;
}

/** Nodes at the heart of the machine; all others are its links. */
const work = /^(part|stock|cutter|holder|tool)/;

/** A mesh of several primitives is a group: its children only carry numbers. */
const nodeName = (object) => object.name || object.parent?.name || '';

/** The attribute that carries the deviation, whatever unit its name adds. */
const deviationOf = (geometry) =>
  Object.keys(geometry.attributes).find((name) => name.startsWith('_deviation'));

export class Stage {
  static async read(bytes, renderer, canvas, onChange) {
    const gltf = await new GLTFLoader().parseAsync(bytes, '');
    return new Stage(gltf, renderer, canvas, onChange);
  }

  constructor(gltf, renderer, canvas, onChange) {
    this.scene = new Scene();
    this.scene.add(gltf.scene);
    this.scene.environment = roomEnvironment(renderer);
    this.scene.environmentIntensity = 0.55;
    this.camera = new PerspectiveCamera(32, 1, 0.01, 100);
    const key = new DirectionalLight(0xffffff, 1.9);
    key.position.set(-0.8, 1.2, 0.9);
    this.scene.add(key, this.camera);
    this.sortObjects(gltf.scene);
    this.startAnimation(gltf);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', onChange);
    this.frame();
  }

  sortObjects(root) {
    this.lines = [];
    this.coloured = [];
    this.probed = [];
    this.links = [];
    this.seeThrough = false;
    this.coloursOn = true;
    root.traverse((object) => {
      if (object.isLine) this.lines.push(object);
      if (!object.isMesh) return;
      if (deviationOf(object.geometry)) this.probed.push(object);
      if (object.geometry.attributes.color && deviationOf(object.geometry)) {
        object.material.roughness = Math.max(object.material.roughness, partRoughness);
        this.coloured.push(object);
      }
      if (!work.test(nodeName(object))) this.links.push(object);
    });
    // Without a cutter it is no machine, and there is nothing to see through.
    if (!root.getObjectByName('cutter')) this.links = [];
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

  /** The machine becomes a shadow around the cutter and the part. */
  setSeeThrough(on) {
    this.seeThrough = on;
    for (const { material } of this.links) {
      material.transparent = on;
      material.opacity = on ? 0.13 : 1;
      material.depthWrite = !on;
      material.needsUpdate = true;
    }
  }

  setColours(on) {
    this.coloursOn = on;
    for (const mesh of this.coloured) {
      mesh.material.vertexColors = on;
      if (!on) mesh.userData.ownColour = mesh.material.color.clone();
      if (on && mesh.userData.ownColour) mesh.material.color.copy(mesh.userData.ownColour);
      else if (!on) mesh.material.color.set(0xaeb4bb);
      mesh.material.needsUpdate = true;
    }
  }

  /** Puts the whole model into the picture, as large as its box allows. */
  frame() {
    const box = new Box3().setFromObject(this.scene);
    const centre = box.getCenter(new Vector3()), half = box.getSize(new Vector3()).multiplyScalar(0.5);
    const radius = Math.max(half.length(), 1e-6);
    const right = new Vector3(0, 1, 0).cross(lookFrom).normalize(), up = lookFrom.clone().cross(right);
    const rise = Math.tan((this.camera.fov * Math.PI) / 360), run = rise * this.camera.aspect;
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const at = new Vector3(corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z);
      const sideways = Math.max(Math.abs(at.dot(right)) / run, Math.abs(at.dot(up)) / rise);
      distance = Math.max(distance, at.dot(lookFrom) + sideways);
    }
    distance *= margin;
    this.camera.position.copy(lookFrom).multiplyScalar(distance).add(centre);
    this.camera.near = radius / 100;
    this.camera.far = 4 * distance + 20 * radius;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(centre);
    this.controls.minDistance = radius / 30;
    this.controls.maxDistance = 3 * distance;
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
    return ray.intersectObjects(objects, true).find((found) => found.object.isMesh && found.object.visible);
  }

  centreOn(pointer) {
    const found = this.hit(pointer, [this.scene]);
    if (!found) return;
    this.controls.target.copy(found.point);
    this.controls.update();
  }

  /** The part's deviation under the pointer, in the file's unit; null beside the part. */
  readDeviation(pointer) {
    const found = this.hit(pointer, this.probed);
    if (!found) return null;
    const geometry = found.object.geometry, values = geometry.attributes[deviationOf(geometry)];
    const { a, b, c } = found.face, weight = found.barycoord;
    return values.getX(a) * weight.x + values.getX(b) * weight.y + values.getX(c) * weight.z;
  }

  render(renderer) {
    renderer.render(this.scene, this.camera);
  }
}
