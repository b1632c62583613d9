// What the page says beside the models: the program's lines and times, the findings, the colours.

function json(id) {
  const holder = document.getElementById(id);
  return holder ? JSON.parse(holder.textContent) : null;
}

/** The last index whose value is below `wanted`, plus one: where it would stand. */
function placeIn(values, wanted) {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < wanted) low = middle + 1;
    else high = middle;
  }
  return low;
}

export class Program {
  constructor(data) {
    this.data = data ?? { file: '', from_s: 0, to_s: 0, t_ms: [], line: [], text: {}, tools: [], error_um: 0 };
    this.numbers = Object.keys(this.data.text).map(Number).sort((a, b) => a - b);
  }

  static read() { return new Program(json('program-data')); }

  /** Index of the stretch that runs at a program time, s; -1: nobody says. */
  at(seconds) {
    const { t_ms: ends } = this.data;
    return ends.length ? Math.min(placeIn(ends, seconds * 1000 - 1e-6), ends.length - 1) : -1;
  }

  line(index) { return this.data.line[index] ?? 0; }
  end(index) { return this.data.t_ms[index] / 1000; }
  text(line) { return this.data.text[line] ?? ''; }

  /** Lines that run, around one: {line, text, at}. */
  around(line, neighbours) {
    const place = placeIn(this.numbers, line);
    const found = this.numbers.slice(Math.max(0, place - neighbours), place + neighbours + 1);
    return found.map((number) => ({ line: number, text: this.text(number), at: number === line }));
  }
}

export const readFindings = () => json('findings-data') ?? [];

/** Stops of the deviation's colours at equal distances from the lower end over zero to the upper one. */
export function readScale(host) {
  if (!host.dataset.stops) return null;
  const stops = host.dataset.stops.split(' ').map((stop) => stop.split(',').map((value) => Number(value) / 255));
  return { stops, low: Number(host.dataset.low), high: Number(host.dataset.high) };
}

/** sRGB 0..1 of a deviation: half of the stops lie below zero, half above. */
export function colourAt(scale, value) {
  const place = value < 0 ? -Math.min(1, value / scale.low) : Math.min(1, value / scale.high);
  const at = ((place + 1) / 2) * (scale.stops.length - 1), below = Math.min(Math.floor(at), scale.stops.length - 2);
  const share = at - below, a = scale.stops[below], b = scale.stops[below + 1];
  return a.map((channel, k) => channel + share * (b[k] - channel));
}
