// Emitted shaders with what each line takes and who spends it, budgets with their headroom, and errors by their source.

// One bar for each limited resource.
function headroomBars(resources) {
  const grid = element('div', {class: 'headroom'});
  for (const {name, rest, used, limit} of resources) {
    const known = used !== null,
      share = limit > 0 ? used / limit : used > 0 ? 2 : 0,
      left = limit - used,
      digits = value => String(Number(value.toPrecision(3)));
    grid.append(
      element(
        'div',
        {class: 'limit'},
        element('span', {}, name, rest && element('span', {class: 'rest'}, rest)),
        element(
          'span',
          {class: share > 1 ? 'track over' : 'track', role: 'img', 'aria-label': `${known ? used : 'unknown'} of ${limit}`},
          element('span', {class: 'fill', style: `width: ${Math.min(100, 100 * share)}%`}),
        ),
        element(
          'span',
          {class: 'value'},
          known
            ? `${digits(used)} of ${limit}: ` + (left < 0 ? `${digits(-left)} over` : `${digits(left)} left`)
            : `not known, at most ${limit}`,
        ),
      ),
    );
  }
  return grid;
}

// What the data could not measure, and why.
function refusals() {
  const rows = (data.refused ?? []).map(row => ({
    variant: data.variants[row.variant],
    sentence: row.sentence,
  }));
  return rows.length
    ? [
        element('h3', {}, 'Refused: what a target cannot hold'),
        table(
          [
            {name: 'Variant', of: row => variantName(row.variant)},
            {name: 'Why', words: true, of: row => row.sentence},
          ],
          rows,
          {id: 'refused-table'},
        ),
      ]
    : [];
}

function makeBudget() {
  const section = sectionOf('budget');
  const limited = data.variants
    .map((variant, index) => ({variant, index}))
    .filter(({variant}) => variant.resources?.length);
  if (!limited.length) {
    section.append(
      absent(
        'No variant of this data is for a target with limits. The Direct3D 9 profiles (ps_2_0, ps_2_b, ' +
          'ps_3_0) have them: add one to the targets of the sweep.',
      ),
      ...refusals(),
    );
    return;
  }
  const share = row => (row.limit > 0 ? row.used / row.limit : row.used > 0 ? 2 : 0);
  const tightest = variant => [...variant.resources].sort((a, b) => share(b) - share(a))[0];
  section.append(
    element('h3', {}, 'What each variant is nearest to running out of'),
    headroomBars(
      limited.map(({variant}) => {
        const {resource, used, limit} = tightest(variant);
        const [name, rest] = nameParts(variant);
        return {name: `${name}: ${resource}`, rest, used, limit};
      }),
    ),
  );
  const details = element('div');
  const show = value => {
    const variant = data.variants[Number(value)];
    details.replaceChildren(headroomBars(variant.resources.map(row => ({name: row.resource, ...row}))));
  };
  section.append(
    element('h3', {}, 'Every limit of one variant'),
    element(
      'div',
      {class: 'controls'},
      choice(
        'Variant',
        'budget-variant',
        limited.map(({variant, index}) => [String(index), variantName(variant)]),
        String(limited[0].index),
        show,
      ),
    ),
    details,
  );
  show(limited[0].index);
  const rows = limited.flatMap(({variant}) => variant.resources.map(row => ({variant, ...row})));
  section.append(
    tableBehind(`Table of all limits: ${rows.length} rows`, () =>
      table(
        [
          {name: 'Variant', of: row => variantName(row.variant)},
          {name: 'Resource', of: row => row.resource},
          {name: 'Used', number: true, of: row => row.used},
          {name: 'Limit', number: true, of: row => row.limit},
          {name: 'Left', number: true, of: row => (row.used === null ? null : row.limit - row.used)},
          {name: 'Who says so', of: row => row.by ?? 'the profile'},
          {name: 'Command', command: true, of: row => row.variant.explain_command},
        ],
        rows,
        {id: 'budget-table'},
      ),
    ),
    ...refusals(),
  );
}

// Lines of one shader; what they take is shaded by its share of the dearest line.
function sourceTable(source) {
  const dearest = Math.max(1, ...(source.lines ?? []).map(line => (line ? line[0] + line[1] : 0)));
  const rows = source.text
    .replace(/\n$/, '')
    .split('\n')
    .map((text, index) => {
      const spent = source.lines?.[index];
      return element(
        'tr',
        spent ? {class: 'spends', style: `--share: ${(0.6 * (spent[0] + spent[1])) / dearest}`} : {},
        element('td', {class: 'number'}, String(index + 1)),
        ...(source.lines
          ? [
              element('td', {class: 'number slots'}, spent ? String(spent[0]) : ''),
              element('td', {class: 'number slots'}, spent ? String(spent[1]) : ''),
            ]
          : []),
        element('td', {class: 'text'}, text),
      );
    });
  const head = element(
    'tr',
    {},
    element('th', {class: 'number'}, 'Line'),
    ...(source.lines
      ? [
          element('th', {class: 'number'}, source.line_units[0]),
          element('th', {class: 'number'}, source.line_units[1]),
        ]
      : []),
    element('th', {}, 'Text'),
  );
  return element(
    'div',
    {class: 'scroll code', tabindex: 0, role: 'region', 'aria-label': 'Shader text'},
    element('table', {id: 'source-text'}, element('thead', {}, head), element('tbody', {}, ...rows)),
  );
}

// Who spends it: the steps of a technique, dearest first, each with its lines of C++.
function spentTable(spent) {
  const steps = new Map();
  for (const line of spent.lines) {
    if (!steps.has(line.step)) steps.set(line.step, []);
    steps.get(line.step).push(line);
  }
  const sum = (lines, key) => lines.reduce((total, line) => total + line[key], 0);
  const dearest = Math.max(1, ...spent.lines.map(line => line.arithmetic + line.texture));
  const row = (attributes, name, {arithmetic, texture}) =>
    element(
      'tr',
      attributes,
      element('td', {class: 'number slots'}, String(arithmetic)),
      element('td', {class: 'number slots'}, String(texture)),
      element('td', {class: 'place'}, ...name.split(/(?<=\/)/).flatMap(part => [part, element('wbr')])),
    );
  const rows = [...steps].flatMap(([step, lines]) => [
    row({class: 'step'}, step || 'outside steps', {
      arithmetic: sum(lines, 'arithmetic'),
      texture: sum(lines, 'texture'),
    }),
    ...lines.map(line =>
      row(
        {class: 'spends', style: `--share: ${(0.6 * (line.arithmetic + line.texture)) / dearest}`},
        line.place || 'unknown line',
        line,
      ),
    ),
  ]);
  const head = element(
    'tr',
    {},
    element('th', {class: 'number'}, `Arithmetic ${spent.unit}`),
    element('th', {class: 'number'}, `Texture ${spent.unit}`),
    element('th', {}, 'Step, and its lines of C++'),
  );
  return element(
    'div',
    {class: 'scroll code', tabindex: 0, role: 'region', 'aria-label': 'Who spends it'},
    element('table', {id: 'source-spent'}, element('thead', {}, head), element('tbody', {}, ...rows)),
  );
}

function readsTable(reads) {
  const hasLevels = reads.some(read => read.level != null);
  return tableBehind(`Texture reads: ${reads.length}`, () =>
    table(
      [
        {name: 'Texture', of: read => read.sampler},
        ...(hasLevels ? [{name: 'Dependent level', number: true, of: read => read.level}] : []),
        {name: 'Step', of: read => read.step || 'outside steps'},
        {name: 'Line of C++', of: read => read.place || 'unknown'},
      ],
      reads,
      {id: 'source-reads'},
    ),
  );
}

let showSource = () => {};

function makeSource() {
  const section = sectionOf('source');
  const known = data.variants
    .map((variant, index) => ({variant, index}))
    .filter(({variant}) => variant.source != null);
  if (!known.length) {
    section.append(absent('No shader text is in this report.'));
    return;
  }
  const box = element('div');
  const fill = value => {
    const variant = data.variants[Number(value)],
      source = data.sources[variant.source];
    const ofLanguage =
      'Operations are those of the optimised shader as it is printed: each vector operation and each branch ' +
      "counts once, and so does a loop's body.";
    box.replaceChildren(
      command(variant.emit_command),
      element('p', {class: 'note'}, source.lines_note ?? ofLanguage),
      element('div', {class: 'beside'}, sourceTable(source), spentTable(source.spent)),
      readsTable(source.spent.reads),
      command(variant.explain_command),
    );
  };
  const select = choice(
    'Variant',
    'source-variant',
    known.map(({variant, index}) => [String(index), variantName(variant)]),
    String(known[0].index),
    fill,
  );
  showSource = index => {
    select.querySelector('select').value = String(index);
    fill(index);
    section.scrollIntoView();
  };
  section.append(element('div', {class: 'controls'}, select), box);
  fill(known[0].index);
}

// Stacked bars: what each source adds to the error of one case.
const sourcesOfError = [
  ['technique', 'blue', 'technique'],
  ['filter', 'orange', '8-bit filter weights'],
  ['arithmetic', 'purple', 'arithmetic'],
];

function makeSplit(view) {
  const cases = view.filter.cases().filter(item => item.split);
  const rows = [];
  for (const [variant, own] of byVariant(cases)) {
    const total = item => sourcesOfError.reduce((sum, [key]) => sum + (item.split[key] ?? 0), 0);
    rows.push({variant, case: own.reduce((most, item) => (total(item) > total(most) ? item : most))});
  }
  const chosen = new Set(variantsChosen(view.choices.lines, cases));
  const share = view.choices.unit === 'share';
  // Of a total of nothing there are no shares.
  const shown = (row, key) =>
    (row.case.split[key] ?? 0) * (!share ? 1 : row.case.split.total > 0 ? 100 / row.case.split.total : 0);
  const points = rows.filter(row => chosen.has(row.variant) && visible(row));
  if (!points.length)
    return {label: 'Nothing to draw with these choices.', points, techniques: techniquesIn(rows)};
  const texels = {
    text: share ? '% of the mean error' : 'mean error in texels',
    display: true,
    color: css('ink'),
    font: {size: 13},
  };
  return {
    label: `Error by source; ${view.filter.words()}`,
    note: `Shown: ${view.filter.words()}. How: ${data.made_by?.split}.`,
    points,
    techniques: techniquesIn(rows),
    columns: [
      ...caseColumns,
      {name: 'mean error (texels)', number: true, of: row => row.case.split.total},
      ...sourcesOfError.map(([key, , name]) => ({
        name: `${name} (texels)`,
        number: true,
        of: row => row.case.split[key],
      })),
      commandColumn,
    ],
    config: {
      type: 'bar',
      data: {
        labels: points.map(row => shortName(data.variants[row.variant])),
        datasets: sourcesOfError.map(([key, colour, name]) => ({
          label: name,
          backgroundColor: css(colour),
          borderColor: css('paper'),
          borderWidth: 1,
          data: points.map(row => ({
            ...row,
            x: shown(row, key),
            y: shortName(data.variants[row.variant]),
          })),
        })),
      },
      options: {
        indexAxis: 'y',
        scales: {
          x: {stacked: true, grid: {color: css('grid')}, ticks: {color: css('soft')}, title: texels},
          y: {stacked: true, grid: {display: false}, ticks: {color: css('ink'), autoSkip: false}},
        },
        plugins: {
          legend: {display: true, position: 'top', labels: {color: css('ink')}},
          tooltip: {
            callbacks: {
              label: context =>
                `${context.dataset.label}: ${plain(context.parsed.x)} ${share ? '%' : 'texels'}`,
            },
          },
        },
      },
    },
  };
}
