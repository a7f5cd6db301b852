// The parts that sections are made of: elements, choices, tables with all their numbers, commands to copy.

function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value == null || value === false) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (name === 'style') node.style.cssText = value;
    else node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.filter(child => child != null && child !== false));
  return node;
}

const sectionOf = id => document.getElementById(id);
const absent = words => element('p', {class: 'absent'}, words);

// A labelled select.  `options`: [[value, name]].  Hidden where there is nothing to choose.
function choice(label, id, options, value, change) {
  const select = element('select', {id, onchange: () => change(select.value)});
  const box = element('label', {class: 'choice'}, label, select);
  fillChoice(box, options, value);
  return box;
}

// Its options anew.
function fillChoice(box, options, value) {
  const select = box.querySelector('select');
  select.replaceChildren(...options.map(([key, name]) => element('option', {value: key}, name)));
  select.value = value;
  box.hidden = options.length < 2;
}

function copyButton(text) {
  const button = element(
    'button',
    {
      type: 'button',
      title: 'Copy this command',
      onclick: async () => {
        try {
          await navigator.clipboard.writeText(text);
        } catch {
          // a page from a file may not have a clipboard
          const area = element('textarea', {}, text);
          document.body.append(area);
          area.select();
          document.execCommand('copy');
          area.remove();
        }
        button.textContent = 'copied';
        setTimeout(() => {
          button.textContent = 'copy';
        }, 1500);
      },
    },
    'copy',
  );
  return button;
}

const command = text =>
  text
    ? element('div', {class: 'command'}, element('code', {}, text), copyButton(text))
    : element('span', {class: 'note'}, 'no command: the data does not say which file its map was');

// The table behind a plot.  `columns`: {name, of(row), number}; a click on a head sorts by it.  `isMarked` rows are bold.
function table(columns, rows, {id, isMarked = () => false} = {}) {
  const body = element('tbody');
  const fill = ordered =>
    body.replaceChildren(
      ...ordered.map(row =>
        element(
          'tr',
          {class: isMarked(row) ? 'front' : null},
          ...columns.map(column => {
            const value = column.of(row);
            if (column.command)
              return element(
                'td',
                {},
                value ? copyButton(value) : '',
                element('code', {title: value}, ` ${value ?? '–'}`),
              );
            return element(
              'td',
              {class: column.number ? 'number' : column.words ? 'words' : null, 'data-value': value},
              column.number ? plain(value) : String(value ?? '–'),
            );
          }),
        ),
      ),
    );
  let sorted = null,
    descending = false;
  const sortBy = column => {
    descending = sorted === column && !descending;
    sorted = column;
    const key = row => column.of(row) ?? (column.number ? Infinity : '￿');
    fill(
      [...rows].sort((a, b) => {
        const [left, right] = descending ? [key(b), key(a)] : [key(a), key(b)];
        return column.number
          ? left - right
          : String(left).localeCompare(String(right), undefined, {numeric: true});
      }),
    );
  };
  const head = element(
    'thead',
    {},
    element(
      'tr',
      {},
      ...columns.map(column =>
        element(
          'th',
          {class: column.number ? 'number' : null, scope: 'col'},
          column.command
            ? column.name
            : element('button', {type: 'button', onclick: () => sortBy(column)}, column.name),
        ),
      ),
    ),
  );
  fill(rows);
  return element(
    'div',
    {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Table'},
    element('table', {id}, head, body),
  );
}

// A table that opens under its plot, filled only then: some have thousands of cells.
function tableBehind(title, make) {
  const details = element('details', {class: 'behind'}, element('summary', {}, title));
  details.addEventListener('toggle', () => {
    if (details.open && details.children.length === 1) details.append(make());
  });
  details.refresh = newTitle => {
    details.firstChild.textContent = newTitle ?? title;
    if (details.children.length > 1) details.lastChild.replaceWith(make());
  };
  return details;
}

// The numbers of a case, with its command and the way to its picture and its code.
function caseCard(item, measures, {withPicture = true} = {}) {
  const variant = variantOf(item);
  const entries = measures.map(measure => {
    const value = measure.of(item);
    return element(
      'div',
      {},
      element('dt', {}, measure.name),
      element(
        'dd',
        {'data-value': value},
        value == null
          ? 'not measured'
          : `${plain(value)} ${measure.unit}${quartilesText(quartilesOf(measure, item))}`,
      ),
    );
  });
  const links = [];
  if (withPicture && hasPicture(item))
    links.push(element('button', {type: 'button', onclick: () => showPicture(item)}, 'its picture'));
  if (variant.source != null)
    links.push(element('button', {type: 'button', onclick: () => showSource(item.variant)}, 'its code'));
  return element(
    'div',
    {class: 'picked', 'aria-live': 'polite'},
    element('b', {}, variantName(variant)),
    element(
      'span',
      {},
      ` on ${data.maps[item.map].name}, seen from ${directionName(item.view)}, lit from ${directionName(item.light)}`,
    ),
    element('dl', {}, ...entries),
    element('div', {class: 'controls'}, ...links),
    command(item.command),
  );
}
