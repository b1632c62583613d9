// The 3D view of report.html: a tab for the finished part, one for the machine in motion.
import { Program, readFindings } from './data.js';
import { Panel } from './panel.js';

const host = document.getElementById('viewer');

/** The bytes of a <script type="application/octet-stream"> holding base64, or null when there is none. */
function embeddedBytes(id) {
  const holder = document.getElementById(id);
  if (!holder) return null;
  const binary = atob(holder.textContent);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes.buffer;
}

function hasWebGl() {
  return Boolean(document.createElement('canvas').getContext('webgl2'));
}

function start() {
  const files = {};
  for (const tab of ['part', 'machine']) {
    if (document.getElementById(`${tab}-glb`)) files[tab] = () => embeddedBytes(`${tab}-glb`);
  }
  if (!Object.keys(files).length) return;
  if (!hasWebGl()) {
    host.querySelector('.fallback').textContent =
      'This browser offers no WebGL 2, so the 3D view cannot be drawn. The stills below show the same part.';
    return;
  }
  panel = new Panel(host, files);
  return panel.open(Object.keys(files)[0]);
}

let panel = null, started = null;
const ensureStarted = () => (started ??= Promise.resolve(start()));

/** To the finding's place in the drawing; a reader who follows a link is not moved away from it. */
async function showInView(number, scroll) {
  await ensureStarted();
  if (!panel) return;
  if (scroll) host.scrollIntoView({ block: 'start' });
  await panel.showFinding(number);
}

/** The movie at the finding's second: it runs evenly over the program from data.from_s to data.to_s, unless shots cut it together. */
function showInMovie(number, scroll) {
  const video = document.querySelector('#movie video[data-even]'), finding = readFindings()[number - 1];
  if (!video || !finding || finding.t_s === null) return;
  const { from_s, to_s } = Program.read().data;
  const seek = () => { video.currentTime = (video.duration * (finding.t_s - from_s)) / Math.max(to_s - from_s, 1e-9); };
  video.pause();
  if (video.readyState >= 1) seek();
  else video.addEventListener('loadedmetadata', seek, { once: true });
  if (scroll) video.scrollIntoView({ block: 'center' });
}

if (host) document.addEventListener('click', (event) => {
  const from = event.target.closest('[data-show]');
  if (!from) return;
  const number = Number(from.dataset.finding);
  showInView(number, from.dataset.show === 'view');
  showInMovie(number, from.dataset.show === 'movie');
});

/** report.html#finding-3, as it was mailed. */
function followLink() {
  const number = Number(/^#finding-(\d+)$/.exec(window.location.hash)?.[1] ?? 0);
  if (!number) return;
  showInView(number, false);
  showInMovie(number, false);
}
if (host) window.addEventListener('hashchange', followLink);

/** Nothing is decoded before the reader comes near: the page opens at once. */
function startWhenNear(host) {
  const observer = new IntersectionObserver(
    (entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      ensureStarted();
    },
    { rootMargin: '600px' },
  );
  observer.observe(host);
}

if (host) {
  startWhenNear(host);
  followLink();
}
