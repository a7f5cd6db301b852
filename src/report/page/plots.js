// The plots.  Each is a section with choices above, a legend below, the numbers of a picked point, and the table of
// everything that is drawn.

// What of the cases is looked at; every plot has its own.  Directions are told apart by all their angles.
const dimensions = [
  {
    id: 'map',
    label: 'Map',
    of: c => c.map,
    name: value => data.maps[value].name,
    all: 'all maps (worst of each)',
  },
  {
    id: 'elevation',
    label: 'View elevation',
    of: c => c.view.elevation,
    name: value => `${plain(value)}°`,
    all: 'all elevations (worst of each)',
  },
  {
    id: 'azimuth',
    label: 'View azimuth',
    of: c => c.view.azimuth,
    name: value => `${plain(value)}°`,
    all: 'all azimuths (worst of each)',
  },
  {
    id: 'light',
    label: 'Light',
    of: c => `${c.light.elevation}/${c.light.azimuth}`,
    name: value => {
      const [elevation, azimuth] = value.split('/');
      return directionName({elevation: Number(elevation), azimuth: Number(azimuth)});
    },
    all: 'all lights (worst of each)',
  },
  {
    id: 'scale',
    label: 'Depth of the relief',
    of: c => c.scale ?? '',
    name: value => plain(value),
    all: 'all depths (worst of each)',
  },
  {
    id: 'precision',
    label: 'Arithmetic',
    of: c => c.arithmetic ?? '',
    name: String,
    all: 'all (worst of each)',
  },
  {id: 'target', label: 'Target', of: c => variantOf(c).target, name: String, all: 'all targets'},
];

const dimensionNamed = id => dimensions.find(each => each.id === id);

// Where a plot starts: the first map, a view of about 30 degrees, everything of the rest but one arithmetic.
function startOf(dimension, values) {
  if (dimension.id === 'map') return String(values[0]);
  if (dimension.id === 'elevation')
    return String(
      values.reduce((best, value) => (Math.abs(value - 30) < Math.abs(best - 30) ? value : best)),
    );
  if (dimension.id === 'precision') return String(values.includes('fp32') ? 'fp32' : values[0]);
  return worst;
}

// A section's choices of dimensions among `items`: `state` by dimension id, and the cases that are left.  Each choice
// offers what occurs with those before it; one that does not occur any more starts anew.
function makeFilter(prefix, items, ids, redraw) {
  const state = {},
    offered = {},
    boxes = {};
  const isLeft = (item, id) => state[id] === worst || String(dimensionNamed(id).of(item)) === state[id];
  const follow = () => {
    let left = items;
    for (const id of ids) {
      const dimension = dimensionNamed(id),
        values = (offered[id] = valuesOf(left, dimension.of)),
        options = values.map(value => [String(value), dimension.name(value)]);
      if (state[id] !== worst && !options.some(([key]) => key === state[id]))
        state[id] = startOf(dimension, values);
      if (options.length > 1) options.push([worst, dimension.all]);
      fillChoice(boxes[id], options, options.length > 1 ? state[id] : options[0]?.[0]);
      left = left.filter(item => isLeft(item, id));
    }
  };
  for (const id of ids)
    boxes[id] = choice(dimensionNamed(id).label, `${prefix}-${id}`, [], '', value => {
      state[id] = value;
      follow();
      redraw();
    });
  follow();
  const cases = () => items.filter(item => ids.every(id => isLeft(item, id)));
  // Of what there is more than one in the data.
  const words = () =>
    ids
      .filter(id => valuesOf(data.cases, dimensionNamed(id).of).length > 1)
      .map(id => {
        const dimension = dimensionNamed(id),
          values = offered[id].filter(value => offered[id].length === 1 || String(value) === state[id]);
        return values.length ? `${dimension.label.toLowerCase()} ${dimension.name(values[0])}` : dimension.all;
      })
      .join(', ');
  return {state, controls: Object.values(boxes), cases, words};
}

const measureOptions = measures => measures.map(measure => [measure.id, `${measure.name} (${measure.unit})`]);
const measureNamed = (measures, id) => measures.find(measure => measure.id === id);

// The rows of a table are drawn points with the case that gave the error.
const caseColumns = [
  {name: 'Variant', of: row => variantName(variantOf(row.case))},
  {name: 'Map', of: row => data.maps[row.case.map].name},
  {name: 'View', of: row => directionName(row.case.view)},
];
const commandColumn = {name: 'Command', command: true, of: row => row.case.command};

// One point for each variant: the greatest error of its cases, its mean cost with the means of its quartiles, and the
// case with that error.
function pointsOf(items, cost, error) {
  const points = [];
  for (const [variant, own] of byVariant(items)) {
    const y = greatest(own.map(error.of)),
      x = mean(own.map(cost.of));
    if (x == null || y == null) continue;
    const quartiles = (cost.quartiles ?? []).map(quartile => mean(own.map(quartile)));
    points.push({variant, x, y, quartiles, case: own.find(item => error.of(item) === y)});
  }
  return points;
}

function tooltipOf(lines) {
  return {displayColors: false, callbacks: {title: () => '', label: context => lines(context.raw)}};
}

// A dataset of one technique.
function series(technique, points, xAxis, yAxis, withLine) {
  const look = lookOf(technique);
  return {
    label: technique,
    type: withLine ? 'line' : 'scatter',
    showLine: withLine,
    data: points.map(point => ({...point, value: point, x: xAxis.place(point.x), y: yAxis.place(point.y)})),
    borderColor: look.colour,
    backgroundColor: look.colour,
    pointStyle: look.shape,
    borderDash: look.dash,
    borderWidth: 2,
    pointBorderWidth: 2,
    radius: 5,
    hoverRadius: 8,
    hitRadius: 8,
  };
}

// A section with a chart of `items`: `make(view)` gives {config, label, points, columns}; `extra` are its own choices.
function plotSection(id, {items = data.cases, filterIds, extra = () => [], make, withLine, tableTitle}) {
  const section = sectionOf(id);
  let drawn = null;
  const redraw = () => chart.draw();
  const filter = makeFilter(id, items, filterIds, redraw);
  const view = {filter, choices: {}};
  const behind = tableBehind('', () =>
    table(drawn?.columns ?? [], drawn?.points ?? [], {
      id: `${id}-table`,
      isMarked: row => Boolean(row.onFront),
    }),
  );
  const legendBox = element('div'),
    pickedBox = element('div'),
    noteBox = element('p', {class: 'note'});
  const chart = chartBox(
    () => {
      drawn = make(view);
      const shown = techniques.filter(technique => (drawn.techniques ?? []).includes(technique));
      legendBox.replaceChildren(legend(shown, withLine));
      noteBox.textContent = drawn.note ?? '';
      behind.hidden = !drawn.points?.length;
      behind.refresh(`${tableTitle}: ${drawn.points?.length ?? 0} rows`);
      return drawn;
    },
    point =>
      pickedBox.replaceChildren(
        caseCard(point.case ?? point.value.case, [...errorMeasures, ...costMeasures]),
      ),
  );
  section.append(
    element('div', {class: 'controls'}, ...extra(view, redraw), ...filter.controls),
    chart.box,
    legendBox,
    noteBox,
    pickedBox,
    behind,
  );
  charts.add(chart);
  section.chart = chart;
}

const visible = point => !hiddenTechniques.has(data.variants[point.variant].technique);
const techniquesIn = points => [...new Set(points.map(point => data.variants[point.variant].technique))];
const ofTechnique = (points, technique) =>
  points.filter(point => data.variants[point.variant].technique === technique);

function measureChoice(view, key, label, measures, prefix, redraw) {
  view.choices[key] = measures[0].id;
  return choice(label, `${prefix}-${key}`, measureOptions(measures), measures[0].id, value => {
    view.choices[key] = value;
    redraw();
  });
}

function makePareto(view) {
  const cost = measureNamed(costMeasures, view.choices.cost),
    error = measureNamed(errorMeasures, view.choices.error);
  const cases = view.filter.cases();
  const all = pointsOf(cases, cost, error);
  const points = all.filter(visible).sort((a, b) => a.x - b.x || a.y - b.y);
  const without = byVariant(cases).length - all.length;
  const note =
    (without
      ? `${without} of the ${byVariant(cases).length} variants have no value of “${cost.name}” or of the error, and are not drawn. `
      : '') +
    `Shown: ${view.filter.words()}.` +
    (cost.quartiles ? ' Bars reach from quartile to quartile of the rounds.' : '');
  if (!points.length)
    return {label: `No variant has both of these here. ${note}`, points, techniques: techniquesIn(all)};
  // What is below the least error that is drawn is no better for it.
  const front = paretoFront(
    points.map(point => ({...point, y: Math.max(point.y, error.floor ?? 0), point})),
  ).map(({point}) => point);
  points.forEach(point => {
    point.onFront = front.includes(point);
  });
  const xAxis = axisFor(
      cost,
      points.flatMap(point => [point.x, ...point.quartiles]),
    ),
    yAxis = axisFor(
      error,
      points.map(point => point.y),
    );
  const datasets = techniquesIn(points).map(technique =>
    series(technique, ofTechnique(points, technique), xAxis, yAxis, false),
  );
  const placed = front.map(point => ({
    x: xAxis.place(point.x),
    y: yAxis.place(point.y),
    value: point,
    case: point.case,
  }));
  datasets.push({
    label: 'Pareto front',
    type: 'line',
    data: placed,
    stepped: 'before',
    showLine: true,
    borderColor: css('ink'),
    borderWidth: 1.5,
    radius: 0,
    hitRadius: 0,
    hoverRadius: 0,
    order: 1,
  });
  return {
    label: `${error.name} against ${cost.name}; ${view.filter.words()}`,
    note,
    points,
    techniques: techniquesIn(all),
    columns: [
      ...caseColumns,
      {name: `${cost.name} (${cost.unit})`, number: true, of: row => row.x},
      ...(cost.quartiles ?? []).map((_, i) => ({
        name: quartileNames[i],
        number: true,
        of: row => row.quartiles[i],
      })),
      {name: `${error.name} (${error.unit})`, number: true, of: row => row.y},
      {name: 'On the front', of: row => (row.onFront ? 'yes' : 'no')},
      commandColumn,
    ],
    config: {
      data: {datasets},
      options: {
        scales: {x: xAxis, y: yAxis},
        plugins: {
          frontLabels: {
            avoid: points.map(point => ({x: xAxis.place(point.x), y: yAxis.place(point.y)})),
            points: placed.map(point => ({...point, text: shortName(data.variants[point.value.variant])})),
          },
          tooltip: tooltipOf(raw => [
            variantName(data.variants[raw.value.variant]),
            `${error.name}: ${plain(raw.value.y)} ${error.unit}`,
            `${cost.name}: ${plain(raw.value.x)} ${cost.unit}${quartilesText(raw.value.quartiles)}`,
          ]),
        },
      },
      plugins: [spreadBars, frontLabels],
    },
  };
}

// Lines of one error over an axis of numbers, one for each group of cases.
function makeLines(view, {groups, xName, xOf, error, columns, note}) {
  const points = [],
    lines = [];
  for (const {technique, name, cases} of groups) {
    const own = [];
    for (const x of valuesOf(cases, xOf)) {
      const here = cases.filter(item => xOf(item) === x);
      const y = greatest(here.map(error.of));
      if (y != null)
        own.push({x, y, line: name, variant: here[0].variant, case: here.find(item => error.of(item) === y)});
    }
    points.push(...own);
    if (own.length) lines.push({technique, name, own});
  }
  const shown = points.filter(visible);
  if (!shown.length)
    return {
      label: 'There is nothing to draw with these choices.',
      points: shown,
      techniques: techniquesIn(points),
    };
  const measure = {id: 'x', name: xName, unit: '', floor: null};
  const xAxis = axisFor(
      measure,
      shown.map(point => point.x),
      xName,
    ),
    yAxis = axisFor(
      error,
      shown.map(point => point.y),
    );
  const datasets = lines
    .filter(line => !hiddenTechniques.has(line.technique))
    .map(line => ({...series(line.technique, line.own, xAxis, yAxis, true), label: line.name}));
  return {
    label: `${error.name} against ${xName}; ${view.filter.words()}`,
    note,
    points: shown,
    techniques: techniquesIn(points),
    columns: [
      ...caseColumns,
      {name: xName, number: true, of: row => row.x},
      {name: `${error.name} (${error.unit})`, number: true, of: row => row.y},
      ...(columns ?? []),
      commandColumn,
    ],
    xAxis,
    config: {
      data: {datasets},
      options: {
        scales: {x: xAxis, y: yAxis},
        plugins: {
          tooltip: tooltipOf(raw => [
            raw.value.line,
            `${xName}: ${plain(raw.value.x)}`,
            `${error.name}: ${plain(raw.value.y)} ${error.unit}`,
          ]),
        },
      },
    },
  };
}

// Which variants are lines: one of each technique by its number of steps, or all of one technique; of a scene all, as
// each is there for a surface and a target of its own.
function lineChoices() {
  if (isPlanned) return [['default', 'all']];
  const options = [
    ['few', 'each technique, with its fewest steps'],
    ['default', 'each technique, with a middle number of steps'],
    ['many', 'each technique, with its most steps'],
  ];
  return [...options, ...techniques.map(technique => [`only:${technique}`, `${technique}, all settings`])];
}

function variantsChosen(value, cases) {
  const known = [...new Set(cases.map(item => item.variant))].sort((a, b) => a - b);
  if (isPlanned) return known;
  if (value.startsWith('only:'))
    return known.filter(index => data.variants[index].technique === value.slice(5));
  return techniques.filter(technique => techniquesIn(cases).includes(technique)).map(technique => {
    const knob = stepsKnob(technique);
    const own = known.filter(index => data.variants[index].technique === technique);
    own.sort((a, b) => Number(data.variants[a].knobs[knob] ?? 0) - Number(data.variants[b].knobs[knob] ?? 0));
    return own[value === 'few' ? 0 : value === 'many' ? own.length - 1 : Math.floor((own.length - 1) / 2)];
  });
}

function makeElevation(view) {
  const error = measureNamed(errorMeasures, view.choices.error);
  const cases = view.filter.cases();
  const groups = variantsChosen(view.choices.lines, cases).map(index => ({
    technique: data.variants[index].technique,
    name: variantName(data.variants[index]),
    cases: cases.filter(item => item.variant === index),
  }));
  const made = makeLines(view, {
    groups,
    error,
    xName: 'elevation of the view (degrees)',
    xOf: c => c.view.elevation,
    note: `Shown: ${[view.filter.words(), groups.filter(group => group.cases.length).length + ' variants'].filter(Boolean).join(', ')}.`,
  });
  if (made.xAxis)
    Object.assign(made.xAxis, {
      beginAtZero: false,
      reverse: true,
      min: 0,
      max: 90,
      ticks: {...made.xAxis.ticks, stepSize: 15, maxTicksLimit: 10},
    });
  return made;
}

// The cases of techniques whose steps vary on the map of the case.
function casesWithSteps() {
  const seen = {};
  const stepsOf = item => at(variantOf(item).knobs, stepsKnob(variantOf(item).technique));
  const key = item => `${item.map} ${variantOf(item).technique}`;
  for (const item of data.cases) (seen[key(item)] ??= new Set()).add(stepsOf(item));
  return data.cases.filter(item => stepsOf(item) != null && seen[key(item)].size > 1);
}

function makeMissed(view) {
  const error = measureNamed(errorMeasures, 'missed');
  const cases = view.filter.cases();
  const groups = techniques
    .filter(stepsKnob)
    .map(technique => ({
      technique,
      name: technique,
      cases: cases.filter(
        item => variantOf(item).technique === technique && stepsKnob(technique) in variantOf(item).knobs,
      ),
    }))
    .filter(group => group.cases.length);
  const stepsOf = item => Number(variantOf(item).knobs[stepsKnob(variantOf(item).technique)]);
  const made = makeLines(view, {
    groups,
    error,
    xName: 'steps, by the knob that counts them',
    xOf: stepsOf,
    columns: [{name: 'Knob', of: row => stepsKnob(data.variants[row.variant].technique)}],
    note:
      `The knobs: ${groups.map(group => `${group.technique} ${stepsKnob(group.technique)}`).join(', ')}. ` +
      `Techniques whose steps never varied are left out. Shown: ${view.filter.words()}.`,
  });
  if (made.xAxis)
    Object.assign(made.xAxis, {
      type: 'logarithmic',
      beginAtZero: false,
      min: Math.min(...made.points.map(point => point.x)) / 1.15,
      max: Math.max(...made.points.map(point => point.x)) * 1.15,
      afterBuildTicks: axis => {
        axis.ticks = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512]
          .filter(value => value >= axis.min && value <= axis.max)
          .map(value => ({value}));
      },
    });
  if (made.xAxis) made.xAxis.ticks = {...made.xAxis.ticks, callback: plain2, autoSkip: false};
  return made;
}
