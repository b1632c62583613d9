// The controls around the drawing: tabs, views, switches, section, measuring, play and scrub, the program's lines.
import { readFindings, readScale, Program } from './data.js';
import { kinds, reading, vector } from './measure.js';
import { createRenderer, roles, Stage, views } from './stage.js';

const titles = { part: 'Finished part', machine: 'Machine' };
const speeds = [0.25, 1, 5, 20, 100];
const neighbours = 3;  // lines of the program before and behind the one that runs

function make(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}

/** `colour`: of the lines that it switches; CSS text, or nothing. */
function checkbox(text, checked, onChange, colour) {
  const input = make('input', { type: 'checkbox', checked });
  input.addEventListener('change', () => onChange(input.checked));
  const label = make('label', {}, input, text);
  if (colour) label.append(make('span', { className: 'viewer-swatch', style: `background:${colour}` }));
  return label;
}

function button(text, onClick) {
  const node = make('button', { type: 'button', className: 'plain', textContent: text });
  node.addEventListener('click', onClick);
  return node;
}

/** `entries`: value and text. */
function choice(label, entries, onChange) {
  const select = make('select', {}, ...entries.map(([value, text]) => make('option', { value, textContent: text })));
  select.setAttribute('aria-label', label);
  select.addEventListener('change', () => onChange(select.value));
  const holder = make('label', { className: 'viewer-choice' }, label, select);
  holder.select = select;
  return holder;
}

/** "tool_axis_fan" reads better as "Tool axis fan". */
const readable = (name) => {
  const words = name.replace(/[_.-]+/g, ' ').trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
};
const signed = (value, digits) => `${value < 0 ? '\u2212' : '+'}${Math.abs(value).toFixed(digits)}`;

export class Panel {
  constructor(host, files) {
    this.host = host;
    this.files = files;
    this.timeScale = Number(host.dataset.timeScale) || 1;
    this.unit = host.dataset.unit || '';
    this.program = Program.read();
    this.findings = readFindings();
    this.scale = readScale(host);
    this.stages = {};
    this.speed = 1;
    this.measuring = '';
    this.picked = [];
    this.build();
    this.renderer = createRenderer(this.canvas);
    this.followTheme();
    new ResizeObserver(() => this.resize()).observe(this.stageBox);
  }

  build() {
    this.canvas = make('canvas', { tabIndex: 0 });
    this.canvas.setAttribute('role', 'application');
    this.canvas.setAttribute('aria-label', '3D view; arrow keys turn, with shift they move, plus and minus zoom');
    this.message = make('div', { className: 'viewer-message', role: 'status' });
    this.probe = make('div', { className: 'viewer-probe', hidden: true });
    this.stageBox = make('div', { className: 'viewer-stage' }, this.canvas, this.message, this.probe);
    this.switches = make('div', { className: 'viewer-switches' });
    this.view = choice('View', [['', 'as turned'], ...Object.keys(views).map((name) => [name, name])], (name) => this.look(name));
    const top = make('div', { className: 'viewer-bar top' }, this.buildTabs(), this.view,
      button('Whole', () => { this.stage?.frame(); this.draw(); }),
      button('Work', () => { this.stage?.zoomToWork(); this.draw(); }), make('span', { className: 'viewer-gap' }), this.switches);
    this.info = make('p', { className: 'viewer-info', role: 'status' });
    this.lines = make('pre', { className: 'viewer-program', tabIndex: 0, hidden: true });
    this.lines.setAttribute('aria-label', 'Lines of the program');
    const hint = make('p', { className: 'viewer-hint',
      textContent: 'Drag to turn, wheel or pinch to zoom, right button to shift, double-click to centre on a point; arrow keys turn, with shift they move.' });
    this.host.replaceChildren(top, this.buildTools(), this.stageBox, this.buildPlayer(), this.info, this.lines);
    (document.querySelector('.colour-bar[data-tab]') ?? this.host).after(hint);
    this.canvas.addEventListener('dblclick', (event) => { this.stage?.centreOn(this.pointer(event)); this.draw(); });
    this.canvas.addEventListener('pointermove', (event) => this.queueProbe(event));
    this.canvas.addEventListener('pointerleave', () => { this.probe.hidden = true; });
    this.canvas.addEventListener('pointerdown', (event) => { this.probe.hidden = true; this.pressed = [event.clientX, event.clientY]; });
    this.canvas.addEventListener('click', (event) => this.click(event));
    this.canvas.addEventListener('keydown', (event) => {
      if (this.stage?.key(event)) { event.preventDefault(); this.draw(); }
    });
  }

  look(name) {
    if (!this.stage || !views[name]) return;
    this.stage.frame(undefined, views[name]);
    this.draw();
  }

  buildTools() {
    this.path = choice('Path', [['off', 'hidden'], ['tool', 'by tool'], ['feed', 'by feed']], (by) => this.colourPath(by));
    this.sectionAxis = choice('Section', [['', 'none'], ['0', 'across X'], ['1', 'across Y'], ['2', 'across Z']], () => this.cut(true));
    this.sectionAt = make('input', { type: 'range', min: 0, max: 1, step: 0.001, value: 0.5, hidden: true });
    this.sectionAt.setAttribute('aria-label', 'Place of the section');
    this.sectionAt.addEventListener('input', () => this.cut(false));
    this.measure = choice('Measure', [['', 'nothing'], ...Object.entries(kinds).map(([kind, { title }]) => [kind, title])], (kind) => {
      this.measuring = kind;
      this.picked = [];
      this.stage?.marks.show([]);
      this.say(kind ? `Pick ${kinds[kind].points} point${kinds[kind].points > 1 ? 's' : ''} on the part.` : '');
      this.draw();
    });
    this.deviationTools = make('div', { className: 'viewer-switches', hidden: true }, ...this.buildDeviationTools());
    return make('div', { className: 'viewer-bar top' }, this.path, this.sectionAxis, this.sectionAt, this.measure, this.deviationTools);
  }

  buildDeviationTools() {
    if (!this.scale) return [];
    const limit = (label, side) => {
      const input = make('input', { type: 'number', className: 'viewer-number', step: 'any', value: Math.abs(this.scale[side]), min: 0 });
      input.addEventListener('change', () => this.setLimit(side, Number(input.value)));
      return make('label', { className: 'viewer-choice' }, `${label} ${this.unit}`, input);
    };
    return [limit('Colours to \u2212', 'low'), limit('to +', 'high'),
      button('Deepest', () => this.visitExtreme(-1)), button('Highest', () => this.visitExtreme(1))];
  }

  setLimit(side, value) {
    if (!(value > 0) || !this.stage) return;
    this.scale = { ...this.scale, [side]: side === 'low' ? -value : value };
    this.stage.setScale(this.scale);
    const ends = [this.scale.low, this.scale.low / 2, 0, this.scale.high / 2, this.scale.high];
    document.querySelectorAll('.colour-bar[data-tab] .ramp-ticks span').forEach((tick, i) => {
      tick.textContent = ends[i] === 0 ? '0' : signed(ends[i], 2).replace(/\.?0+$/, '');
    });
    this.draw();
  }

  visitExtreme(sign) {
    const found = this.stage?.extreme(sign);
    if (!found) return;
    this.stage.visit(found.at);
    this.say(`${sign < 0 ? 'Deepest' : 'Highest'}: ${signed(found.deviation, 3)} ${this.unit} at ${reading('point', [{ at: found.at, deviation: null }], this.program.data.error_um)}`);
    this.draw();
  }

  colourPath(by) {
    const range = this.stage?.colourPath(by);
    const legend = this.program.data.tools.map((tool) => tool.name).join(', ');
    this.say(range ? `Feed from ${range.low.toFixed(0)} (dark) to ${range.high.toFixed(0)} mm/min (yellow); rapids grey` : by === 'tool' ? `Path by tool: ${legend}; rapids grey` : '');
    this.draw();
  }

  cut(first) {
    const axis = this.sectionAxis.select.value, { stage } = this;
    this.sectionAt.hidden = axis === '';
    if (!stage) return;
    if (axis === '') { stage.section.clear(); this.say(''); return this.draw(); }
    const k = Number(axis), box = stage.boxOf(stage.workMeshes());
    const ends = [box.min, box.max].map((corner) => stage.toWork(corner).getComponent(k)).sort((a, b) => a - b);
    if (first) this.sectionAt.value = 0.5;
    const at = ends[0] + Number(this.sectionAt.value) * (ends[1] - ends[0]), drawn = stage.section.cut(k, at);
    this.say(`Section at ${'XYZ'[k]} ${at.toFixed(3)} mm${drawn.times ? `; deviations drawn ${drawn.times.toPrecision(2)} times as long` : ''}`);
    this.draw();
  }

  say(text) { this.info.textContent = text; }

  click(event) {
    if (!this.stage || Math.hypot(event.clientX - this.pressed[0], event.clientY - this.pressed[1]) > 4) return;
    const at = this.pointer(event), pin = this.stage.pinAt(at);
    if (!this.measuring) return pin ? this.showFinding(pin) : undefined;
    const picked = this.stage.pick(at);
    if (!picked) return;
    const { points } = kinds[this.measuring];
    this.picked = this.picked.length >= points ? [picked] : [...this.picked, picked];
    this.stage.marks.show(this.picked.map((one) => (this.measuring === 'thickness' ? one : { at: one.at })));
    this.say(this.picked.length === points ? reading(this.measuring, this.picked, this.program.data.error_um)
      : `${this.picked.length} of ${points} points`);
    this.draw();
  }

  /** Finding N of the page: its place, its time, its line; the movie goes there too. */
  async showFinding(number) {
    const finding = this.findings[number - 1];
    if (!finding) return;
    const tab = finding.place && !finding.in_machine && this.files.part ? 'part' : 'machine';
    if (this.files[tab] && (this.tab !== tab || !this.stage)) await this.open(tab);
    if (!this.stage) return;
    if (finding.t_s !== null && this.stage.duration) this.seek((finding.t_s - this.program.data.from_s) / this.timeScale);
    if (finding.place) this.stage.visit(vector(finding.place), finding.in_machine);
    else if (tab === 'machine') this.stage.zoomToWork();
    this.showLine(finding.line);
    const text = document.querySelector(`#finding-${number} p`)?.textContent ?? '';
    this.say(`Finding ${number}: ${text}`);
    this.host.dataset.finding = number;
    this.draw();
  }

  showLine(line) {
    if (!line) { this.lines.hidden = true; return; }
    const around = this.program.around(line, neighbours);
    this.lines.hidden = false;
    if (!around.some((one) => one.at)) around.push({ line, text: '', at: true });
    this.lines.replaceChildren(...around.map((one) =>
      make('span', { className: one.at ? 'at' : '' }, make('i', { textContent: one.line }), `${one.text}\n`)));
  }

  buildTabs() {
    const tabs = make('div', { className: 'viewer-tabs' });
    tabs.setAttribute('role', 'tablist');
    this.tabButtons = {};
    for (const name of Object.keys(this.files)) {
      const button = make('button', { type: 'button', textContent: titles[name] });
      button.setAttribute('role', 'tab');
      button.addEventListener('click', () => this.open(name));
      this.tabButtons[name] = button;
      tabs.append(button);
    }
    return tabs;
  }

  buildPlayer() {
    this.playButton = make('button', { type: 'button', className: 'plain', textContent: 'Play' });
    this.playButton.style.minWidth = '5.2rem';
    this.playButton.addEventListener('click', () => this.setPlaying(!this.playing));
    this.scrub = make('input', { type: 'range', min: 0, max: 1, step: 'any', value: 0, className: 'viewer-scrub' });
    this.scrub.setAttribute('aria-label', 'Program time');
    this.scrub.addEventListener('input', () => this.seek(Number(this.scrub.value)));
    this.scrub.addEventListener('keydown', (event) => {
      const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
      if (!step || !this.program.data.t_ms.length) return;
      event.preventDefault();
      this.stepLine(step);
    });
    const speed = make('select', {}, ...speeds.map((value) =>
      make('option', { value, textContent: `${value}\u00d7`, selected: value === 1 })));
    speed.setAttribute('aria-label', 'Speed');
    speed.addEventListener('change', () => { this.speed = Number(speed.value); });
    this.time = make('span', { className: 'viewer-time' });
    this.tip = make('span', { className: 'viewer-time viewer-tip' });
    this.player = make('div', { className: 'viewer-bar bottom', hidden: true }, this.playButton, this.scrub, this.time, this.tip, speed);
    return this.player;
  }

  /** To the end of the line before, or of the next one. */
  stepLine(step) {
    const now = this.program.at(this.stage.time * this.timeScale + this.program.data.from_s);
    const index = Math.min(Math.max(now + step, 0), this.program.data.t_ms.length - 1);
    this.seek((this.program.end(index) - this.program.data.from_s) / this.timeScale);
  }

  async open(name) {
    this.setPlaying(false);
    this.tab = name;
    this.probe.hidden = true;
    for (const [tab, button] of Object.entries(this.tabButtons)) {
      button.setAttribute('aria-selected', String(tab === name));
    }
    for (const legend of document.querySelectorAll('.colour-bar[data-tab]')) {
      legend.hidden = legend.dataset.tab !== name;
    }
    this.message.textContent = 'Reading the model\u2026';
    try {
      this.stages[name] ??= await Stage.read(this.files[name](), this.renderer, this.canvas, () => this.draw(),
        name === 'part' ? this.scale : null);
      this.message.textContent = '';
    } catch (error) {
      this.message.textContent = `The model cannot be shown: ${error.message}`;
      return;
    }
    this.stage?.controls.disconnect();
    this.stage = this.stages[name];
    this.stage.controls.connect(this.canvas);
    this.showSwitches();
    this.path.hidden = !this.stage.path;
    this.deviationTools.hidden = !this.stage.probed.length || !this.scale;
    this.sectionAxis.select.value = '';
    this.sectionAt.hidden = true;
    this.stage.section.clear();
    this.say('');
    this.showLine(0);
    this.player.hidden = this.stage.duration === 0;
    this.resize();
    this.seek(this.stage.time);
    this.host.dataset.tab = name;  // says that it is drawn
  }

  showSwitches() {
    const { stage } = this;
    const toggle = (text, checked, change, colour) =>
      checkbox(text, checked, (on) => { change(on); this.draw(); }, colour);
    const switches = [];
    for (const role of stage.roles()) {
      if (role === 'part' && stage.roles().length === 1) continue;
      switches.push(toggle(roles[role], stage.roleShown(role), (on) => stage.setRole(role, on)));
    }
    if (stage.coloured.length && this.scale) switches.push(toggle('Deviation colours', stage.coloursOn, (on) => stage.setColours(on)));
    for (const line of stage.lineGroups()) {
      switches.push(toggle(readable(line.name), line.objects[0].visible, (on) => {
        for (const object of line.objects) object.visible = on;
      }, line.colour));
    }
    this.switches.replaceChildren(...switches);
  }

  setPlaying(on) {
    this.playing = on && Boolean(this.stage?.duration);
    this.playButton.textContent = this.playing ? 'Pause' : 'Play';
    if (!this.playing) return;
    if (this.stage.time >= this.stage.duration) this.stage.time = 0;
    this.lastTick = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  tick(now) {
    if (!this.playing) return;
    const elapsed = Math.max(0, now - this.lastTick) / 1000;
    this.lastTick = now;
    this.seek(Math.min(this.stage.duration, this.stage.time + (elapsed * this.speed) / this.timeScale));
    if (this.stage.time >= this.stage.duration) return this.setPlaying(false);
    requestAnimationFrame((next) => this.tick(next));
  }

  /** To a time of the animation, in its own seconds. */
  seek(time) {
    this.stage.seek(time);
    this.scrub.max = this.stage.duration || 1;
    this.scrub.value = time;
    const text = (seconds) => (seconds * this.timeScale + this.program.data.from_s).toFixed(2);
    const index = this.stage.duration ? this.program.at(Number(text(this.stage.time))) : -1;
    const line = index < 0 ? 0 : this.program.line(index);
    this.time.textContent = `${text(this.stage.time)} of ${text(this.stage.duration)} s${line ? `, line ${line}` : ''}`;
    if (this.stage.duration) this.showLine(line);
    const tip = this.stage.toolTip();
    this.tip.textContent = tip ? ['X', 'Y', 'Z'].map((axis, k) => `${axis} ${tip.getComponent(k).toFixed(3)}`).join(' ').replaceAll('-', '\u2212') : '';
    this.host.dataset.stock = this.stage.stockShown();
    this.draw();
  }

  pointer(event) {
    const box = this.canvas.getBoundingClientRect();
    return { x: ((event.clientX - box.left) / box.width) * 2 - 1, y: 1 - ((event.clientY - box.top) / box.height) * 2 };
  }

  /** At most one look at the part per frame, and none while a button is down. */
  queueProbe(event) {
    if (event.buttons || event.pointerType === 'touch' || !this.stage?.probed.length) {
      this.probe.hidden = true;
      return;
    }
    const box = this.canvas.getBoundingClientRect();
    const at = { ...this.pointer(event), left: event.clientX - box.left, top: event.clientY - box.top };
    if (!this.probeAt) requestAnimationFrame(() => this.showProbe());
    this.probeAt = at;
  }

  showProbe() {
    const at = this.probeAt;
    this.probeAt = null;
    const found = this.stage.readDeviation(at);
    this.probe.hidden = found === null;
    if (found === null) return;
    const sign = found < 0 ? '\u2212' : '+';
    this.probe.textContent = `${sign}${Math.abs(found).toFixed(2)} ${this.unit}`;
    const flip = at.left + 120 > this.stageBox.clientWidth;
    this.probe.style.left = `${flip ? at.left - this.probe.offsetWidth - 12 : at.left + 14}px`;
    this.probe.style.top = `${Math.max(4, at.top - 30)}px`;
  }

  followTheme() {
    const apply = () => {
      this.background = getComputedStyle(document.documentElement).getPropertyValue('--view').trim();
      this.renderer.setClearColor(this.background);
      this.draw();
    };
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', apply);
    apply();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.stageBox;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    for (const stage of Object.values(this.stages)) stage.setAspect(width / height);
    this.draw();
  }

  /** On demand only: a page that lies open costs nothing. */
  draw() {
    if (this.drawing || !this.stage) return;
    this.drawing = true;
    requestAnimationFrame(() => {
      this.drawing = false;
      this.stage.render(this.renderer);
    });
  }
}
