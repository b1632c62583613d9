// The controls around the drawing: tabs, switches, play and scrub.
import { createRenderer, Stage } from './stage.js';

const titles = { part: 'Finished part', machine: 'Machine' };
const speeds = [0.25, 1, 5, 20, 100];

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

/** "tool_axis_fan" reads better as "Tool axis fan". */
const readable = (name) => {
  const words = name.replace(/[_.-]+/g, ' ').trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
};

export class Panel {
  constructor(host, files) {
    this.host = host;
    this.files = files;
    this.timeScale = Number(host.dataset.timeScale) || 1;
    this.unit = host.dataset.unit || '';
    this.stages = {};
    this.speed = 1;
    this.build();
    this.renderer = createRenderer(this.canvas);
    this.followTheme();
    new ResizeObserver(() => this.resize()).observe(this.stageBox);
  }

  build() {
    this.canvas = make('canvas', { tabIndex: 0 });
    this.canvas.setAttribute('aria-label', '3D view; drag to turn, wheel to zoom, right button to shift');
    this.message = make('div', { className: 'viewer-message', role: 'status' });
    this.probe = make('div', { className: 'viewer-probe', hidden: true });
    this.stageBox = make('div', { className: 'viewer-stage' }, this.canvas, this.message, this.probe);
    this.switches = make('div', { className: 'viewer-switches' });
    const reset = make('button', { type: 'button', className: 'plain', textContent: 'Reset view' });
    reset.addEventListener('click', () => { this.stage?.frame(); this.draw(); });
    const top = make('div', { className: 'viewer-bar top' }, this.buildTabs(), this.switches,
      make('span', { className: 'viewer-gap' }), reset);
    const hint = make('p', { className: 'viewer-hint',
      textContent: 'Drag to turn, wheel or pinch to zoom, right button to shift, double-click to centre on a point.' });
    this.host.replaceChildren(top, this.stageBox, this.buildPlayer());
    (document.querySelector('.colour-bar[data-tab]') ?? this.host).after(hint);
    this.canvas.addEventListener('dblclick', (event) => {
      this.stage?.centreOn(this.pointer(event));
      this.draw();
    });
    this.canvas.addEventListener('pointermove', (event) => this.queueProbe(event));
    this.canvas.addEventListener('pointerleave', () => { this.probe.hidden = true; });
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
    const speed = make('select', {}, ...speeds.map((value) =>
      make('option', { value, textContent: `${value}\u00d7`, selected: value === 1 })));
    speed.setAttribute('aria-label', 'Speed');
    speed.addEventListener('change', () => { this.speed = Number(speed.value); });
    this.time = make('span', { className: 'viewer-time' });
    this.player = make('div', { className: 'viewer-bar bottom', hidden: true }, this.playButton, this.scrub, this.time, speed);
    return this.player;
  }

  async open(name) {
    this.setPlaying(false);
    for (const [tab, button] of Object.entries(this.tabButtons)) {
      button.setAttribute('aria-selected', String(tab === name));
    }
    for (const legend of document.querySelectorAll('.colour-bar[data-tab]')) {
      legend.hidden = legend.dataset.tab !== name;
    }
    this.message.textContent = 'Reading the model\u2026';
    try {
      this.stages[name] ??= await Stage.read(this.files[name](), this.renderer, this.canvas, () => this.draw());
      this.message.textContent = '';
    } catch (error) {
      this.message.textContent = `The model cannot be shown: ${error.message}`;
      return;
    }
    this.stage?.controls.disconnect();
    this.stage = this.stages[name];
    this.stage.controls.connect(this.canvas);
    this.showSwitches();
    this.player.hidden = this.stage.duration === 0;
    this.resize();
    this.seek(this.stage.time);
  }

  showSwitches() {
    const { stage } = this;
    const toggle = (text, checked, change, colour) =>
      checkbox(text, checked, (on) => { change(on); this.draw(); }, colour);
    const switches = [];
    if (stage.coloured.length) switches.push(toggle('Deviation colours', stage.coloursOn, (on) => stage.setColours(on)));
    for (const line of stage.lineGroups()) {
      switches.push(toggle(readable(line.name), line.objects[0].visible, (on) => {
        for (const object of line.objects) object.visible = on;
      }, line.colour));
    }
    if (stage.links.length) switches.push(toggle('See through the machine', stage.seeThrough, (on) => stage.setSeeThrough(on)));
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
    const text = (seconds) => (seconds * this.timeScale).toFixed(2);
    this.time.textContent = `${text(time)} of ${text(this.stage.duration)} s`;
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
