// What was measured, and what of it can be plotted: the measures of cost and of error, each with its name, its unit and
// where a case has it.  A case is one variant on one map at one view and light; its numbers are the data's, unchanged.

const data = JSON.parse(document.getElementById('data').textContent);
data.cases.forEach((item, index) => {
  item.index = index;
});

const variantOf = item => data.variants[item.variant];
const percent = (part, whole) => (whole > 0 ? (100 * part) / whole : null);
const at = (object, ...path) =>
  path.reduce((value, key) => (value == null ? null : value[key]), object) ?? null;

// `floor`: what is smaller is drawn there, because a logarithmic axis has no zero.
const errorMeasures = [
  {
    id: 'p95',
    name: 'hit error, 95th percentile',
    unit: 'texels',
    floor: 0.001,
    of: c => at(c, 'hits', 'p95'),
  },
  {id: 'median', name: 'hit error, median', unit: 'texels', floor: 0.001, of: c => at(c, 'hits', 'median')},
  {
    id: 'p99',
    name: 'hit error, 99th percentile',
    unit: 'texels',
    floor: 0.001,
    of: c => at(c, 'hits', 'p99'),
  },
  {id: 'max', name: 'hit error, greatest', unit: 'texels', floor: 0.001, of: c => at(c, 'hits', 'max')},
  {
    id: 'missed',
    name: 'missed first hits',
    unit: '% of pixels',
    of: c => percent(at(c, 'hits', 'missed'), at(c, 'hits', 'pixels')),
  },
  {
    id: 'shadow',
    name: 'shadow misjudged',
    unit: '% of pixels',
    of: c => percent(at(c, 'hits', 'shadow_wrong'), at(c, 'hits', 'pixels')),
  },
  {id: 'flip', name: 'FLIP against the exact picture', unit: 'mean', of: c => at(c, 'picture', 'flip_mean')},
  {
    id: 'psnr_loss',
    name: 'picture error (root mean square)',
    unit: 'of full scale',
    floor: 1e-5,
    of: c => (!c.picture ? null : c.picture.psnr == null ? 0 : 10 ** (-c.picture.psnr / 20)),
  },
  {
    id: 'swim',
    name: 'swim under a 0.1° move of the camera, 95th percentile',
    unit: 'texels',
    floor: 0.001,
    of: c => at(c, 'swim', 'p95'),
  },
].filter(measure => data.cases.some(item => measure.of(item) != null));

// {ratio, ratio_low, ratio_high}: of the case, or of its variant.
const timeOf = c => (at(c, 'time', 'ratio') == null ? variantOf(c).time : c.time);

// Chips whose compilers were asked.
const chips = [...new Set(data.variants.flatMap(variant => Object.keys(variant.chips ?? {})))];

const costMeasures = [
  {
    id: 'reads',
    name: 'texture reads of the search and shadow',
    unit: 'per pixel, mean',
    floor: 0.5,
    of: c => at(c, 'reads', 'mean'),
  },
  {
    id: 'slots',
    name: 'Direct3D 9 slots',
    unit: 'arithmetic and texture',
    of: c => {
      const slots = variantOf(c).d3d9;
      return slots ? slots.arithmetic + slots.texture : null;
    },
  },
  {
    id: 'alu',
    name: 'SPIR-V arithmetic instructions',
    unit: 'in the optimised shader',
    of: c => at(variantOf(c), 'spirv', 'alu'),
  },
  {
    id: 'path',
    name: 'SPIR-V instructions on the longest path',
    unit: 'executed',
    floor: 1,
    of: c => at(variantOf(c), 'spirv', 'longest_path'),
  },
  {
    id: 'instructions',
    name: 'instructions executed',
    unit: 'per pixel, mean',
    floor: 1,
    of: c => at(c, 'instructions', 'mean'),
  },
  ...chips.flatMap(chip => [
    {
      id: `${chip}-throughput`,
      name: `inverse throughput on ${chip} by its compiler`,
      unit: 'cycles',
      floor: 1,
      of: c => at(variantOf(c), 'chips', chip, 'inverse_throughput'),
    },
    {
      id: `${chip}-instructions`,
      name: `instructions on ${chip} by its compiler`,
      unit: 'in the binary',
      floor: 1,
      of: c => at(variantOf(c), 'chips', chip, 'instructions'),
    },
  ]),
  {
    id: 'time',
    name: 'time, as a ratio to the first variant',
    unit: 'on the device',
    floor: 0.5,
    of: c => at(timeOf(c), 'ratio'),
    quartiles: ['ratio_low', 'ratio_high'].map(key => c => at(timeOf(c), key)),
  },
].filter(measure => data.cases.some(item => measure.of(item) != null));

// Techniques in the order in which they are measured; their place decides colour, shape and dash.
const techniques = [...new Set(data.variants.map(variant => variant.technique))];

const directionName = ({elevation, azimuth}) => `elevation ${plain(elevation)}°, azimuth ${plain(azimuth)}°`;
// What was asked of a variant besides surface and target.  What a scene knows of it is in its command and its text: it
// is long, and the scene's surface stands for it.
const settingsText = variant =>
  [
    ...Object.entries(variant.knobs).map(([name, value]) => `${name} = ${value}`),
    ...Object.entries(variant.loops ?? {})
      .filter(([, form]) => form !== 'schedule')
      .map(([name, form]) => `${name}: ${form}`),
    ...(variant.per_vertex ? ['per vertex'] : []),
    ...(variant.scene_surface ? [] : (variant.known ?? [])),
  ].join(', ');
// Its name begins with what tells it from the others: of a planned scene surface and target are enough, and what was
// chosen for them comes after.
const nameParts = variant => {
  const chosen = [variant.surface, settingsText(variant)],
    [lead, rest] = variant.scene_surface
      ? [[variant.scene_surface, variant.target], chosen]
      : [[...chosen, variant.target], []];
  return [lead, rest].map(words => words.filter(Boolean).join(' · '));
};
const variantName = variant => nameParts(variant).filter(Boolean).join(' · ');
// In few words, beside points and bars.
const shortName = variant =>
  (variant.scene_surface
    ? [variant.scene_surface, variant.target]
    : [variant.technique, Object.values(variant.knobs).join(', ')]
  )
    .filter(Boolean)
    .join(' ');
// Whether a plan chose the variants, for each surface of its scene and target one.
const isPlanned = data.variants.length > 0 && data.variants.every(variant => variant.scene_surface);

// The knob that a technique's variants differ in and that says how many steps it takes; null where none does.
function stepsKnob(technique) {
  const values = {};
  for (const variant of data.variants)
    if (variant.technique === technique)
      for (const [name, value] of Object.entries(variant.knobs)) (values[name] ??= new Set()).add(value);
  const counts = /step|tap|cell|node|iteration|section|layer/;
  const names = Object.keys(values).filter(name => values[name].size > 1 && counts.test(name));
  return names.sort((a, b) => values[b].size - values[a].size)[0] ?? null;
}

// Of a measure that is a median over rounds, its quartiles as words.
function quartilesText(values) {
  return values.length && values.every(value => value != null)
    ? `, quartiles ${values.map(plain).join(' and ')}`
    : '';
}
const quartilesOf = (measure, item) => (measure.quartiles ?? []).map(quartile => quartile(item));
const quartileNames = ['lower quartile of its rounds', 'upper quartile of its rounds'];

// Numbers for people: three digits, no exponents.  The full number is in the table cell's data-value.
function plain(value) {
  if (value == null) return '–';
  if (typeof value !== 'number') return String(value);
  const size = Math.abs(value);
  if (size === 0) return '0';
  if (size < 0.001) return '<0.001';
  if (Number.isInteger(value) || size >= 1000) return String(Math.round(value));
  return String(Number(value.toPrecision(3)));
}

// The values there are of one property of the cases, in order.
function valuesOf(items, property) {
  const values = [...new Set(items.map(property))];
  return values.sort((a, b) => (typeof a === 'number' ? a - b : String(a).localeCompare(String(b))));
}

const worst = 'worst';
// Of several cases of one variant the greatest, as percentiles of different views cannot be merged.
const greatest = values =>
  values.every(value => value == null) ? null : Math.max(...values.filter(value => value != null));
const mean = values => {
  const known = values.filter(value => value != null);
  return known.length ? known.reduce((sum, value) => sum + value, 0) / known.length : null;
};

// Cases by variant: [[variant index, cases]].
function byVariant(items) {
  const groups = new Map();
  for (const item of items) {
    if (!groups.has(item.variant)) groups.set(item.variant, []);
    groups.get(item.variant).push(item);
  }
  return [...groups];
}

// The points that no other point is at least as cheap and as accurate as, from cheap to dear.
function paretoFront(points) {
  const front = [];
  for (const point of [...points].sort((a, b) => a.x - b.x || a.y - b.y))
    if (!front.length || point.y < front[front.length - 1].y) front.push(point);
  return front;
}
