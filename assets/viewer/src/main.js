// The 3D view of report.html: a tab for the finished part, one for the machine in motion.
import { Panel } from './panel.js';

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

function start(host) {
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
  new Panel(host, files).open(Object.keys(files)[0]);
}

/** Nothing is decoded before the reader comes near: the page opens at once. */
function startWhenNear(host) {
  const observer = new IntersectionObserver(
    (entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      start(host);
    },
    { rootMargin: '600px' },
  );
  observer.observe(host);
}

const host = document.getElementById('viewer');
if (host) startWhenNear(host);
