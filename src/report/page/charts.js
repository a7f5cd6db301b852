// How data looks: a colour, a shape and a dash for each technique, the same in every plot and legend, and charts that
// follow the colour scheme.

const colourNames = ['blue', 'vermillion', 'green', 'purple', 'orange', 'sky', 'black'];
const shapes = ['circle', 'rect', 'triangle', 'rectRot', 'star', 'crossRot'];
const dashes = [[], [7, 4], [2, 3]];

const css = name => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

// Seven colours, and another shape and dash for each seven: no two techniques share both.
function lookOf(technique) {
  const place = techniques.indexOf(technique);
  return {
    colour: css(colourNames[place % colourNames.length]),
    shape: shapes[(((place % 2) * 3) % shapes.length) + (Math.floor(place / colourNames.length) % 3)],
    dash: dashes[Math.floor(place / colourNames.length) % dashes.length],
  };
}

const hiddenTechniques = new Set();
const charts = new Set(); // of {draw()}
const redrawAll = () => charts.forEach(chart => chart.draw());

function applyTheme() {
  const wanted = document.getElementById('theme').value;
  const dark = wanted === 'dark' || (wanted === 'auto' && matchMedia('(prefers-color-scheme: dark)').matches);
  document.documentElement.dataset.theme = dark ? 'dark' : 'light';
  redrawAll();
}

// A glyph as charts draw it: line, then shape.
function drawGlyph(canvas, technique, withLine) {
  const ratio = 2,
    context = canvas.getContext('2d'),
    look = lookOf(technique);
  canvas.width = 28 * ratio;
  canvas.height = 14 * ratio;
  context.scale(ratio, ratio);
  context.strokeStyle = context.fillStyle = look.colour;
  context.lineWidth = 2;
  if (withLine) {
    context.setLineDash(look.dash);
    context.beginPath();
    context.moveTo(1, 7);
    context.lineTo(27, 7);
    context.stroke();
    context.setLineDash([]);
  }
  Chart.helpers.drawPoint(context, {pointStyle: look.shape, radius: 5, rotation: 0, borderWidth: 2}, 14, 7);
}

// Buttons that show and hide a technique, in all plots at once.
function legend(shown, withLine) {
  const list = element('div', {
    class: 'legend',
    role: 'group',
    'aria-label': 'Techniques; press to hide or show',
  });
  for (const technique of shown) {
    const glyph = element('canvas', {'aria-hidden': 'true'});
    drawGlyph(glyph, technique, withLine);
    list.append(
      element(
        'button',
        {
          type: 'button',
          'aria-pressed': String(!hiddenTechniques.has(technique)),
          'data-technique': technique,
          onclick: () => {
            hiddenTechniques.has(technique)
              ? hiddenTechniques.delete(technique)
              : hiddenTechniques.add(technique);
            redrawAll();
          },
        },
        glyph,
        technique,
      ),
    );
  }
  return list;
}

// The ticks of a logarithmic axis that people can read: 1, 2 and 5 of each decade, or 1 alone where there are many.
function logTicks(axis) {
  const decades = Math.log10(axis.max / axis.min);
  const steps = decades > 3 ? [1] : decades > 1.5 ? [1, 3] : [1, 2, 5];
  const ticks = [];
  for (let power = Math.floor(Math.log10(axis.min)); power <= Math.ceil(Math.log10(axis.max)); ++power)
    for (const step of steps) {
      const value = step * 10 ** power;
      if (value >= axis.min * 0.999 && value <= axis.max * 1.001) ticks.push({value});
    }
  axis.ticks = ticks;
}

// An axis for a measure: logarithmic where it spans more than a decade and a half, linear else.
function axisFor(measure, values, title) {
  const known = values.filter(value => value != null);
  const floor = measure.floor;
  const top = Math.max(...known, floor ?? 0);
  const least = Math.min(...known.filter(value => value > 0));
  const grid = {color: css('grid')},
    colours = {color: css('soft')};
  const name = {
    display: true,
    text: title ?? `${measure.name} (${measure.unit})`,
    color: css('ink'),
    font: {size: 13},
  };
  if (floor == null || top / Math.max(least, floor) < 20)
    return {
      type: 'linear',
      beginAtZero: true,
      suggestedMax: top,
      grid,
      title: name,
      ticks: {...colours, maxTicksLimit: 8},
      place: value => value,
    };
  const isCut = known.some(value => value < floor);
  return {
    type: 'logarithmic',
    grid,
    title: name,
    min: floor * (isCut ? 0.8 : 1),
    max: top * 1.25,
    afterBuildTicks: axis => {
      logTicks(axis);
      if (isCut) axis.ticks = [{value: floor}, ...axis.ticks.filter(tick => tick.value > floor * 1.3)];
    },
    place: value => Math.max(value, floor),
    ticks: {
      ...colours,
      autoSkip: false,
      callback: value => (isCut && Math.abs(value / floor - 1) < 0.01 ? `≤ ${plain2(value)}` : plain2(value)),
    },
  };
}
// Ticks keep what plain() would cut.
const plain2 = value => String(Number(value.toPrecision(6)));

// From quartile to quartile of a cost that was measured in rounds.
const spreadBars = {
  id: 'spreadBars',
  beforeDatasetsDraw(chart) {
    const {ctx} = chart;
    ctx.save();
    ctx.lineWidth = 1.5;
    for (const set of chart.data.datasets)
      for (const {y, value} of set.data) {
        const [low, high] = value?.quartiles ?? [];
        if (low == null || high == null || set.radius === 0) continue;
        ctx.strokeStyle = set.borderColor;
        const middle = chart.scales.y.getPixelForValue(y),
          ends = [low, high].map(end => chart.scales.x.getPixelForValue(end));
        ctx.beginPath();
        ctx.moveTo(ends[0], middle);
        ctx.lineTo(ends[1], middle);
        for (const end of ends) {
          ctx.moveTo(end, middle - 4);
          ctx.lineTo(end, middle + 4);
        }
        ctx.stroke();
      }
    ctx.restore();
  },
};

// Names beside the points of a front, left out where they would cover one another.
const frontLabels = {
  id: 'frontLabels',
  afterDatasetsDraw(chart, _arguments, options) {
    const {ctx, chartArea: area} = chart;
    const taken = (options.avoid ?? []).map(({x, y}) => {
      const px = chart.scales.x.getPixelForValue(x),
        py = chart.scales.y.getPixelForValue(y);
      return {left: px - 5, right: px + 5, top: py - 5, bottom: py + 5};
    });
    ctx.save();
    ctx.font = '12px system-ui, sans-serif';
    ctx.textBaseline = 'middle';
    for (const {x, y, text} of options.points ?? []) {
      const px = chart.scales.x.getPixelForValue(x),
        py = chart.scales.y.getPixelForValue(y);
      const width = ctx.measureText(text).width;
      const toLeft = px + 12 + width > area.right;
      const left = toLeft ? px - 12 - width : px + 12;
      const spot = [py - 14, py + 14, py - 28, py + 28, py - 42, py]
        .map(middle => ({left: left - 2, right: left + width + 2, top: middle - 7, bottom: middle + 7}))
        .find(
          box =>
            box.top > area.top &&
            box.bottom < area.bottom &&
            box.left > area.left &&
            taken.every(
              other =>
                box.left > other.right ||
                box.right < other.left ||
                box.top > other.bottom ||
                box.bottom < other.top,
            ),
        );
      if (!spot) continue;
      taken.push(spot);
      if (Math.abs(spot.top + 7 - py) > 15) {
        // far away: say whose it is
        ctx.strokeStyle = css('soft');
        ctx.beginPath();
        ctx.moveTo(px, py);
        ctx.lineTo(toLeft ? spot.right : spot.left, spot.top + 7);
        ctx.stroke();
      }
      ctx.fillStyle = css('paper');
      ctx.globalAlpha = 0.8;
      ctx.fillRect(spot.left, spot.top, spot.right - spot.left, 14);
      ctx.globalAlpha = 1;
      ctx.fillStyle = css('ink');
      ctx.fillText(text, spot.left + 2, spot.top + 7);
    }
    ctx.restore();
  },
};

// A chart in a box of its own that is made anew with what `make` returns: {config, label}.  A click on a point calls
// `pick` with the point.
function chartBox(make, pick) {
  const canvas = element('canvas', {role: 'img'});
  const box = element('div', {class: 'plot'}, canvas);
  let chart = null;
  const draw = () => {
    const made = make();
    chart?.destroy();
    chart = null;
    canvas.hidden = !made.config;
    box.classList.toggle('empty', !made.config);
    box.querySelector('.absent')?.remove();
    if (!made.config) {
      box.append(absent(made.label));
      return;
    }
    canvas.setAttribute('aria-label', made.label);
    const options = (made.config.options ??= {});
    Object.assign(options, {
      animation: false,
      responsive: true,
      maintainAspectRatio: false,
      onClick: (_event, elements, current) => {
        if (!elements.length || !pick) return;
        const {datasetIndex, index} = elements[0];
        pick(current.data.datasets[datasetIndex].data[index]);
      },
    });
    options.plugins = {legend: {display: false}, ...options.plugins};
    chart = new Chart(canvas, made.config);
    box.chart = chart;
  };
  return {box, draw};
}
