// Readings under the pointer: the nearest drawn point of every line in a plot, in the plot's own units.
(() => {
  const svgName = 'http://www.w3.org/2000/svg';

  const numbers = (text) => text.split(' ').map(Number);

  const pointsOf = (path) =>
    path.getAttribute('d').split('M').filter(Boolean).flatMap((run) => {
      const values = numbers(run), points = [];
      for (let i = 0; i + 1 < values.length; i += 2) points.push([values[i], values[i + 1]]);
      return points;
    });

  const nearest = (points, x) => {
    let best = null;
    for (const point of points) if (!best || Math.abs(point[0] - x) < Math.abs(best[0] - x)) best = point;
    return best;
  };

  // As many digits as show a thousandth of the axis.
  const digits = (value, span) => {
    const decimals = 3 - Math.floor(Math.log10(span));
    const text = decimals > 9 ? value.toExponential(3) : value.toFixed(Math.max(0, decimals));
    return text.replaceAll('-', '\u2212');
  };
  const withUnit = (text, unit) => (unit ? `${text} ${unit}` : text);

  function attach(card) {
    const svg = card.querySelector('svg.plot'), paths = [...svg.querySelectorAll('path.series')];
    if (!paths.length) return;
    const [left, right, bottom, top] = numbers(svg.dataset.box);
    const [xLow, xHigh, yLow, yHigh] = numbers(svg.dataset.range);
    const names = [...card.querySelectorAll('.legend li')].map((item) => item.textContent);
    const lines = paths.map(pointsOf);
    const rule = document.createElementNS(svgName, 'path');
    rule.setAttribute('class', 'reading-line');
    const box = document.createElement('div');
    box.className = 'reading';
    const hide = () => { rule.remove(); box.remove(); };

    svg.addEventListener('pointerleave', hide);
    svg.addEventListener('pointermove', (event) => {
      const frame = svg.getBoundingClientRect(), scale = svg.viewBox.baseVal.width / frame.width;
      const at = (event.clientX - frame.left) * scale;
      if (at < left || at > right) return hide();
      const found = lines.map((points) => nearest(points, at));
      const x = found[0][0];
      rule.setAttribute('d', `M${x} ${bottom}V${top}`);
      const xValue = xLow + ((x - left) / (right - left)) * (xHigh - xLow);
      const rows = found.map(([, y], i) => {
        const value = yLow + ((y - bottom) / (top - bottom)) * (yHigh - yLow);
        return `${names[i] ? names[i] + ': ' : ''}${withUnit(digits(value, yHigh - yLow), svg.dataset.yUnit)}`;
      });
      box.innerText = [`at ${withUnit(digits(xValue, xHigh - xLow), svg.dataset.xUnit)}`, ...rows].join('\n');
      svg.append(rule);
      card.append(box);
      const place = x / scale + frame.left - card.getBoundingClientRect().left;
      const flip = place + box.offsetWidth + 16 > card.clientWidth;
      box.style.left = `${flip ? place - box.offsetWidth - 10 : place + 10}px`;
      box.style.top = `${frame.top - card.getBoundingClientRect().top + 30 / scale}px`;
    });
  }

  document.querySelectorAll('.plot-card').forEach(attach);

  // The movie's poster is the picture at the top, which the page already holds.
  const hero = document.querySelector('.hero img'), video = document.querySelector('#movie video');
  if (hero && video) video.poster = hero.src;
})();
