// Measuring on the part's mesh: points in the work frame, mm, with what the mesh itself is off by.
import { BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments, Points, PointsMaterial, Vector3 } from 'three';

export const kinds = {
  point: { title: 'Point', points: 1 },
  distance: { title: 'Distance', points: 2 },
  thickness: { title: 'Thickness', points: 1 },
  radius: { title: 'Radius', points: 3 },
};

const number = (value, digits = 3) => value.toFixed(digits).replaceAll('-', '\u2212');
const place = (p) => `X ${number(p.x)} Y ${number(p.y)} Z ${number(p.z)} mm`;

/** Of the circle through three points: its radius and centre; null when they lie on a line. */
export function circleThrough(a, b, c) {
  const u = b.clone().sub(a), v = c.clone().sub(a), normal = u.clone().cross(v), area2 = normal.lengthSq();
  if (area2 < 1e-12 * u.lengthSq() * v.lengthSq()) return null;
  const centre = normal.clone().cross(u).multiplyScalar(v.lengthSq())
    .add(v.clone().cross(normal).multiplyScalar(u.lengthSq())).divideScalar(2 * area2);
  return { radius: centre.length(), centre: centre.add(a) };
}

/** `error_um`: how far a point of the mesh may be from the part's surface. */
export function reading(kind, picked, error_um) {
  const points = picked.map((one) => one.at), off = error_um / 1000;
  const within = (times) => `\u00b1 ${number(times * off)} mm`;
  if (kind === 'point') {
    const { deviation } = picked[0];
    const um = deviation === null ? '' : `, deviation ${deviation < 0 ? '\u2212' : '+'}${Math.abs(deviation).toFixed(2)} \u00b5m`;
    return `${place(points[0])} ${within(1)}${um}`;
  }
  if (kind === 'distance') {
    const [a, b] = points, by = b.clone().sub(a);
    return `${number(by.length())} mm ${within(2)} (dX ${number(by.x)}, dY ${number(by.y)}, dZ ${number(by.z)})`;
  }
  if (kind === 'thickness') {
    const { through } = picked[0];
    return through === null ? 'nothing lies behind this point' : `${number(through)} mm thick ${within(2)} along the normal at ${place(points[0])}`;
  }
  const circle = circleThrough(...points);
  if (!circle) return 'the three points lie on a line';
  // A point that is off moves the radius by up to r / sagitta of the arc that was picked.
  const [a, b, c] = points, chord = Math.max(a.distanceTo(b), b.distanceTo(c), c.distanceTo(a)) / 2;
  const half = Math.min(1, chord / circle.radius), sagitta = circle.radius * (1 - Math.sqrt(1 - half * half));
  return `R ${number(circle.radius)} mm ${within(2 * circle.radius / Math.max(sagitta, 1e-9))}, centre ${place(circle.centre)}`;
}

/** Marks of what was picked, in the work frame. */
export class Marks {
  constructor(work) {
    this.work = work;
    this.points = new Points(new BufferGeometry(), new PointsMaterial({ color: 0xb3261e, size: 9, sizeAttenuation: false, depthTest: false, toneMapped: false }));
    this.lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: 0xb3261e, depthTest: false, toneMapped: false }));
    for (const object of [this.points, this.lines]) { object.renderOrder = 3; object.frustumCulled = false; work.add(object); }
    this.show([]);
  }

  show(picked) {
    const flat = (list) => new Float32BufferAttribute(list.flatMap((p) => [p.x, p.y, p.z]), 3);
    const at = picked.map((one) => one.at), ways = [];
    for (let i = 1; i < at.length; ++i) ways.push(at[i - 1], at[i]);
    for (const one of picked) if (one.end) ways.push(one.at, one.end);
    this.points.geometry.setAttribute('position', flat(at));
    this.lines.geometry.setAttribute('position', flat(ways));
    this.points.visible = at.length > 0;
    this.lines.visible = ways.length > 0;
  }
}

export const vector = (list) => new Vector3(...list);
