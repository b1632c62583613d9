// A plane through the part: what lies before it is cut away, its profile drawn, deviations as whiskers.
import { BufferGeometry, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Plane, Vector3 } from 'three';

/** Whiskers as long as this share of the part stand for a deviation at the scene's limit. */
const whiskerShare = 0.03;

/** By this share of the part the plane that is drawn lies below the one that is asked for: a wall in the very plane is cut or
 * taken away, all of it, whatever its vertices are rounded by. */
const offWallsShare = 1e-4;

const inks = { profile: 0x10151b, whisker: 0xc4501b, exaggerated: 0x0a5fb4 };

/** Corners of all triangles in the work frame, mm, with the deviation at each, um; NaN: not measured. */
function trianglesOf(meshes, work, deviationAt) {
  const corners = [], values = [], point = new Vector3();
  for (const mesh of meshes) {
    const { position } = mesh.geometry.attributes, index = mesh.geometry.index;
    const toWork = work.matrixWorld.clone().invert().multiply(mesh.matrixWorld), measured = deviationAt(mesh);
    const count = index ? index.count : position.count;
    for (let i = 0; i < count; ++i) {
      const vertex = index ? index.getX(i) : i;
      point.fromBufferAttribute(position, vertex).applyMatrix4(toWork);
      corners.push(point.x, point.y, point.z);
      values.push(measured ? measured(vertex) : NaN);
    }
  }
  return { corners: new Float32Array(corners), values: new Float32Array(values) };
}

function lines(points, colour) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(points, 3));
  const object = new LineSegments(geometry, new LineBasicMaterial({ color: colour, toneMapped: false, depthTest: false }));
  object.renderOrder = 2;
  return object;
}

export class Section {
  /** `work`: node of the work frame (mm); `deviationAt(mesh)`: a reader by vertex, or null. */
  constructor(work, meshes, deviationAt, limits) {
    this.work = work;
    this.meshes = meshes;
    this.deviationAt = deviationAt;
    this.limits = limits;
    this.drawn = new Group();
    work.add(this.drawn);
    this.plane = new Plane();
  }

  clear() {
    for (const mesh of this.meshes) { mesh.material.clippingPlanes = null; mesh.material.needsUpdate = true; }
    this.empty();
  }

  empty() {
    for (const object of this.drawn.children) { object.geometry.dispose(); object.material.dispose(); }
    this.drawn.clear();
  }

  /** Cuts at `asked` mm of axis 0, 1 or 2; what has more than that is cut away. Returns what whiskers are drawn by. */
  cut(axis, asked) {
    this.triangles ??= trianglesOf(this.meshes, this.work, this.deviationAt);
    this.size ??= this.longestSide();
    const normal = new Vector3().setComponent(axis, -1), value = asked - offWallsShare * this.size;
    this.plane.set(normal, value).applyMatrix4(this.work.matrixWorld);
    this.plane.normalize();
    for (const mesh of this.meshes) { mesh.material.clippingPlanes = [this.plane]; mesh.material.needsUpdate = true; }
    this.empty();
    return this.drawProfile(axis, value);
  }

  drawProfile(axis, value) {
    const { corners, values } = this.triangles, profile = [], whiskers = [], shifted = [];
    const { size } = this;
    const limit = this.limits ? Math.max(-this.limits.low, this.limits.high) : 0;
    const times = limit > 0 ? (whiskerShare * size) / (limit / 1000) : 0;
    for (let t = 0; t < corners.length; t += 9) {
      const ends = crossing(corners, values, t, axis, value);
      if (!ends) continue;
      const [a, b, normal] = ends;
      profile.push(...a.at, ...b.at);
      if (!times || Number.isNaN(a.value) || Number.isNaN(b.value)) continue;
      const [p, q] = [a, b].map((end) => end.at.map((x, k) => x + normal[k] * times * (end.value / 1000)));
      shifted.push(...p, ...q);
      whiskers.push(...a.at, ...p);
    }
    this.drawn.add(lines(profile, inks.profile));
    if (whiskers.length) this.drawn.add(lines(whiskers, inks.whisker), lines(shifted, inks.exaggerated));
    return { segments: profile.length / 6, times: whiskers.length ? times : 0 };
  }

  longestSide() {
    const { corners } = this.triangles, low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < corners.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], corners[i]);
      high[i % 3] = Math.max(high[i % 3], corners[i]);
    }
    return Math.max(...high.map((value, k) => value - low[k]));
  }
}

/** Where a triangle meets the plane: two ends with their deviation, and the outward normal within the plane. */
function crossing(corners, values, t, axis, value) {
  const ends = [];
  for (let i = 0; i < 3; ++i) {
    const a = t + 3 * i, b = t + 3 * ((i + 1) % 3), from = corners[a + axis] - value, to = corners[b + axis] - value;
    if (from < 0 === to < 0) continue;
    const share = from / (from - to), at = [0, 1, 2].map((k) => corners[a + k] + share * (corners[b + k] - corners[a + k]));
    ends.push({ at, value: values[a / 3] + share * (values[b / 3] - values[a / 3]) });
  }
  if (ends.length !== 2) return null;
  const edge = (k, i) => corners[t + 3 * i + k] - corners[t + k];
  const normal = [edge(1, 1) * edge(2, 2) - edge(2, 1) * edge(1, 2), edge(2, 1) * edge(0, 2) - edge(0, 1) * edge(2, 2),
    edge(0, 1) * edge(1, 2) - edge(1, 1) * edge(0, 2)];
  normal[axis] = 0;
  const length = Math.hypot(...normal) || 1;
  return [...ends, normal.map((x) => x / length)];
}
