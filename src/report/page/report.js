// The page: every section in its order, or the words that say why it is empty.

function makeSummary() {
  const many = (count, word) => `${count.toLocaleString('en')} ${word}${count === 1 ? '' : 's'}`;
  document.getElementById('summary').textContent =
    `${many(data.variants.length, 'variant')} of ${many(techniques.length, 'technique')} on ` +
    `${many(data.maps.length, 'map')} (${data.maps.map(map => map.name).join(', ')}): ${many(data.cases.length, 'case')}. ` +
    `Device: ${data.device || 'not said'}.`;
  document
    .getElementById('contents')
    .append(
      ...[...document.querySelectorAll('main > section')].map(section =>
        element('a', {href: `#${section.id}`}, section.querySelector('h2').textContent),
      ),
    );
}

function makePlots() {
  const noErrors = !data.cases.length || !errorMeasures.length;
  if (noErrors) {
    for (const id of ['pareto', 'elevation', 'missed', 'split'])
      sectionOf(id).append(absent('The data holds no case.'));
    return;
  }
  const rest = ['map', 'azimuth', 'light', 'scale', 'precision', 'target'];
  if (costMeasures.length)
    plotSection('pareto', {
      filterIds: ['map', 'elevation', ...rest.slice(1)],
      make: makePareto,
      withLine: false,
      tableTitle: 'Table of the points',
      extra: (view, redraw) => [
        measureChoice(view, 'cost', 'Cost', costMeasures, 'pareto', redraw),
        measureChoice(view, 'error', 'Error', errorMeasures, 'pareto', redraw),
      ],
    });
  else sectionOf('pareto').append(absent('The data holds errors but no cost.'));

  const lines = (view, id, redraw) => {
    view.choices.lines = 'default';
    return choice('Variants', `${id}-lines`, lineChoices(), 'default', value => {
      view.choices.lines = value;
      redraw();
    });
  };
  if (valuesOf(data.cases, dimensionNamed('elevation').of).length > 1)
    plotSection('elevation', {
      filterIds: rest,
      make: makeElevation,
      withLine: true,
      tableTitle: 'Table of the points',
      extra: (view, redraw) => [
        measureChoice(view, 'error', 'Error', errorMeasures, 'elevation', redraw),
        lines(view, 'elevation', redraw),
      ],
    });
  else
    sectionOf('elevation').append(
      absent('All cases were seen from one elevation, so there is no curve to draw.'),
    );

  if (casesWithSteps().length && measureNamed(errorMeasures, 'missed'))
    plotSection('missed', {
      items: casesWithSteps(),
      filterIds: ['map', 'elevation', ...rest.slice(1)],
      make: makeMissed,
      withLine: true,
      tableTitle: 'Table of the points',
    });
  else sectionOf('missed').append(absent('No technique was measured with more than one number of steps.'));

  if (data.cases.some(item => item.split))
    plotSection('split', {
      items: data.cases.filter(item => item.split),
      filterIds: ['map', 'elevation', ...rest.slice(1)],
      make: makeSplit,
      withLine: false,
      tableTitle: 'Table of the bars',
      extra: (view, redraw) => {
        view.choices.unit = 'texels';
        return [
          lines(view, 'split', redraw),
          choice(
            'Bars',
            'split-unit',
            [
              ['texels', 'in texels'],
              ['share', 'in % of the error'],
            ],
            'texels',
            value => {
              view.choices.unit = value;
              redraw();
            },
          ),
        ];
      },
    });
  else sectionOf('split').append(absent('The errors of this data were not split by source.'));
}

function makeMakers() {
  const section = sectionOf('makers');
  const rows = Object.entries(data.made_by ?? {});
  section.append(
    table(
      [
        {name: 'Number', of: row => row[0].replace(/_/g, ' ')},
        {name: 'Made by', words: true, of: row => row[1]},
      ],
      rows,
      {id: 'makers-table'},
    ),
  );
  section.append(
    element('h3', {}, 'The commands behind the data'),
    ...(data.commands ?? []).map(command),
    element(
      'p',
      {class: 'note'},
      'Every table above has the command of each of its rows; it draws that one case again, with the map of its errors.',
    ),
  );
  section.append(
    tableBehind(`Table of all ${data.cases.length} cases`, () =>
      table(
        [
          ...caseColumns.map(column => ({...column, of: item => column.of({case: item})})),
          {name: 'Light', of: item => directionName(item.light)},
          ...[...costMeasures, ...errorMeasures].flatMap(measure => [
            {name: `${measure.name} (${measure.unit})`, number: true, of: measure.of},
            ...(measure.quartiles ?? []).map((of, i) => ({name: quartileNames[i], number: true, of})),
          ]),
          {name: 'Command', command: true, of: item => item.command},
        ],
        data.cases,
        {id: 'cases-table'},
      ),
    ),
  );
}

makeSummary();
makePlots();
makeBudget();
makeSource();
makeMakers();
document.getElementById('theme').addEventListener('change', applyTheme);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', applyTheme);
applyTheme();
makeGallery().then(() => {
  document.documentElement.dataset.ready = 'yes';
});
