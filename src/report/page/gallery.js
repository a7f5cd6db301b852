// Pictures: renders as they are; error and read maps arrive as one byte a pixel and are coloured here, so that the page
// can say the number under the pointer.

const gallery = data.gallery ?? {entries: [], exact: []};
const pictureOf = item =>
  gallery.entries.find(
    entry =>
      entry.map === item.map &&
      entry.variant === item.variant &&
      entry.view.elevation === item.view.elevation &&
      entry.view.azimuth === item.view.azimuth,
  ) ?? gallery.entries.find(entry => entry.map === item.map && entry.variant === item.variant);
const hasPicture = item => Boolean(pictureOf(item));

// Bytes of an error map: 0 to 253 logarithmic between the least and the most error, then two words.
const missedByte = 254,
  invalidByte = 255,
  lastByte = 253;
const errorOfByte = byte =>
  gallery.least_error * (gallery.most_error / gallery.least_error) ** (byte / lastByte);

// Stops of "inferno" (Smith and van der Walt, 2015) and of "cividis" (Nuñez, Anderton and Renslow, 2018), equally
// spaced: brightness grows all the way, so they read without colour vision.
const inferno = [
  [0, 0, 4],
  [31, 12, 72],
  [87, 16, 109],
  [136, 34, 106],
  [188, 55, 84],
  [228, 89, 49],
  [249, 142, 9],
  [248, 204, 53],
  [252, 255, 164],
];
const cividis = [
  [0, 34, 78],
  [27, 55, 110],
  [66, 78, 108],
  [95, 101, 110],
  [125, 124, 120],
  [157, 149, 118],
  [190, 175, 111],
  [225, 204, 94],
  [254, 232, 56],
];
const missedColour = [89, 217, 255],
  invalidColour = [255, 0, 255];

function ramp(stops, place) {
  const at = Math.min(Math.max(place, 0), 1) * (stops.length - 1),
    below = Math.min(Math.floor(at), stops.length - 2);
  return stops[below].map((value, channel) => value + (stops[below + 1][channel] - value) * (at - below));
}

const errorColour = byte =>
  byte === invalidByte ? invalidColour : byte === missedByte ? missedColour : ramp(inferno, byte / lastByte);
const readsScale = () =>
  Math.max(
    1,
    ...gallery.entries.filter(entry => entry.map === shown.entry?.map).map(entry => entry.reads_max),
  );

const kinds = {
  render: 'this variant',
  exact: 'exact picture',
  error: 'error map',
  reads: 'texture reads',
};
const shown = {entry: null, left: 'render', right: 'error', images: {}};

const loadImage = source =>
  new Promise((resolve, reject) => {
    const image = new Image();
    image.onload = () => resolve(image);
    image.onerror = () => reject(new Error('a picture of this page is damaged'));
    image.src = source;
  });

const sourceOf = (entry, kind) => (kind === 'exact' ? gallery.exact[entry.exact] : entry[kind]);

// The bytes of a one-channel picture.
function bytesOf(image) {
  const canvas = element('canvas', {width: image.width, height: image.height}),
    context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, image.width, image.height).data;
}

function paint(canvas, image, kind) {
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext('2d', {willReadFrequently: true});
  context.drawImage(image, 0, 0);
  if (kind !== 'error' && kind !== 'reads') return null;
  const pixels = context.getImageData(0, 0, image.width, image.height),
    bytes = bytesOf(image),
    most = readsScale();
  for (let i = 0; i < bytes.length; i += 4)
    pixels.data.set(
      kind === 'error' ? errorColour(bytes[i]) : ramp(cividis, (bytes[i] * shown.entry.reads_step) / most),
      i,
    );
  context.putImageData(pixels, 0, 0);
  return bytes;
}

async function makeGallery() {
  const section = sectionOf('gallery');
  if (!gallery.entries.length) {
    section.append(
      absent(gallery.why_none ?? 'There are no pictures: the report was made with --no-pictures.'),
    );
    return;
  }
  const left = element('canvas'),
    right = element('canvas'),
    divider = element('div', {class: 'divider'});
  const leftName = element('span', {class: 'side left'}),
    rightName = element('span', {class: 'side right'});
  const slider = element('input', {
    type: 'range',
    min: 0,
    max: 100,
    value: 50,
    id: 'gallery-slider',
    'aria-label': 'How much of the left picture is shown',
  });
  const readout = element('div', {class: 'readout', 'aria-live': 'off'}),
    scales = element('div'),
    card = element('div');
  const stage = element(
    'div',
    {class: 'stage', id: 'gallery-stage'},
    right,
    left,
    divider,
    leftName,
    rightName,
  );
  const split = () => {
    left.style.clipPath = `inset(0 ${100 - slider.value}% 0 0)`;
    divider.style.left = `${slider.value}%`;
  };
  slider.addEventListener('input', split);
  const drag = event => {
    const box = stage.getBoundingClientRect();
    slider.value = (100 * (event.clientX - box.left)) / box.width;
    split();
  };
  stage.addEventListener('pointerdown', event => {
    stage.setPointerCapture(event.pointerId);
    drag(event);
  });
  stage.addEventListener('pointermove', event => {
    if (event.buttons) drag(event);
    const box = stage.getBoundingClientRect(),
      bytes = shown.bytes;
    if (!bytes) return;
    const x = Math.floor(((event.clientX - box.left) / box.width) * gallery.size),
      y = Math.floor(((event.clientY - box.top) / box.height) * gallery.size);
    if (x < 0 || y < 0 || x >= gallery.size || y >= gallery.size) return;
    const index = 4 * (y * gallery.size + x),
      error = bytes.error[index],
      reads = bytes.reads ? bytes.reads[index] * shown.entry.reads_step : null;
    const words =
      error === invalidByte
        ? 'NaN'
        : error === missedByte
          ? 'missed: the ray went through a feature'
          : error === 0
            ? `error at most ${plain(gallery.least_error)} texels`
            : `error ${plain(errorOfByte(error))} texels`;
    readout.textContent = `pixel ${x}, ${y}: ${words}${reads == null ? '' : `, ${plain(reads)} texture reads`}`;
  });

  const show = async entry => {
    shown.entry = entry;
    const images = {};
    for (const kind of Object.keys(kinds)) {
      const source = sourceOf(entry, kind);
      if (source) images[kind] = await loadImage(source);
    }
    if (shown.entry !== entry) return; // another was asked for meanwhile
    shown.images = images;
    shown.bytes = {error: bytesOf(images.error), reads: images.reads ? bytesOf(images.reads) : null};
    for (const [canvas, name, kind] of [
      [left, leftName, shown.left],
      [right, rightName, shown.right],
    ]) {
      paint(canvas, images[kind] ?? images.render, kind);
      name.textContent = images[kind] ? kinds[kind] : `${kinds[kind]}: not drawn`;
    }
    split();
    scales.replaceChildren(...scaleOf());
    const item = data.cases.find(
      each =>
        each.map === entry.map &&
        each.variant === entry.variant &&
        each.view.elevation === entry.view.elevation &&
        each.view.azimuth === entry.view.azimuth,
    );
    card.replaceChildren(
      item ? caseCard(item, [...errorMeasures, ...costMeasures], {withPicture: false}) : '',
    );
    for (const figure of thumbs.children)
      figure.setAttribute(
        'aria-current',
        String(Number(figure.dataset.entry) === gallery.entries.indexOf(entry)),
      );
    mapSelect.querySelector('select').value = String(entry.map);
    fillChoice(variantSelect, variantOptions(entry), String(entry.variant));
    fillChoice(viewSelect, viewOptions(entry), viewKey(entry));
    stage.dataset.shown = `${gallery.entries.indexOf(entry)}/${shown.left}/${shown.right}`;
  };
  const scaleOf = () => {
    const parts = [];
    const strip = (colours, ticks) => {
      const canvas = element('canvas', {class: 'strip', width: 256, height: 1}),
        context = canvas.getContext('2d');
      for (let x = 0; x < 256; ++x) {
        context.fillStyle = `rgb(${colours(x / 255)
          .map(Math.round)
          .join(',')})`;
        context.fillRect(x, 0, 1, 1);
      }
      return element(
        'div',
        {class: 'scale'},
        canvas,
        element(
          'div',
          {class: 'ticks'},
          ...ticks.map(([place, name]) => element('span', {style: `left: ${100 * place}%`}, name)),
        ),
      );
    };
    if (shown.left === 'error' || shown.right === 'error') {
      const place = value =>
        Math.log(value / gallery.least_error) / Math.log(gallery.most_error / gallery.least_error);
      parts.push(
        element(
          'div',
          {class: 'note'},
          'Error in texels',
          element('span', {class: 'swatch', style: `background: rgb(${missedColour})`}),
          'missed hit',
          element('span', {class: 'swatch', style: `background: rgb(${invalidColour})`}),
          'NaN',
        ),
        strip(
          place_ => ramp(inferno, place_),
          [gallery.least_error, 0.1, 1, 10, gallery.most_error].map(value => [
            place(value),
            value === gallery.least_error
              ? `≤ ${plain2(value)}`
              : value === gallery.most_error
                ? `≥ ${plain2(value)}`
                : plain2(value),
          ]),
        ),
      );
    }
    if (shown.left === 'reads' || shown.right === 'reads') {
      const most = readsScale();
      parts.push(
        element('div', {class: 'note'}, 'Texture reads of search and shadow'),
        strip(
          place_ => ramp(cividis, place_),
          [
            [0, '0'],
            [0.5, plain(most / 2)],
            [1, plain(most)],
          ],
        ),
      );
    }
    return parts;
  };

  const viewKey = entry => `${entry.view.elevation}/${entry.view.azimuth}`;
  const options = (entries, property, name) =>
    valuesOf(entries, property).map(value => [String(value), name(value)]);
  // What there is on an entry's map, and of its variant there.
  const variantOptions = ({map}) =>
    options(
      gallery.entries.filter(entry => entry.map === map),
      entry => entry.variant,
      value => variantName(data.variants[value]),
    );
  const viewOptions = ({map, variant}) =>
    options(
      gallery.entries.filter(entry => entry.map === map && entry.variant === variant),
      viewKey,
      value => {
        const [elevation, azimuth] = value.split('/');
        return directionName({elevation: Number(elevation), azimuth: Number(azimuth)});
      },
    );
  const choose = change => {
    const wanted = {
      map: Number(mapSelect.querySelector('select').value),
      variant: Number(variantSelect.querySelector('select').value),
      view: viewSelect.querySelector('select').value,
      ...change,
    };
    const fits = entry => entry.variant === wanted.variant && entry.map === wanted.map;
    const entry =
      gallery.entries.find(each => fits(each) && viewKey(each) === wanted.view) ??
      gallery.entries.find(fits) ??
      gallery.entries.find(each => each.map === wanted.map);
    if (entry.map !== shown.entry?.map) fillThumbs(entry);
    return show(entry);
  };
  const first =
    gallery.entries.find(entry => data.variants[entry.variant].technique.startsWith('parallax_occlusion')) ??
    gallery.entries[0];
  const mapSelect = choice(
    'Map',
    'gallery-map',
    options(
      gallery.entries,
      entry => entry.map,
      value => data.maps[value].name,
    ),
    String(first.map),
    value => choose({map: Number(value)}),
  );
  const variantSelect = choice(
    'Variant',
    'gallery-variant',
    variantOptions(first),
    String(first.variant),
    value => choose({variant: Number(value)}),
  );
  const viewSelect = choice(
    'View',
    'gallery-view',
    viewOptions(first),
    viewKey(first),
    value => choose({view: value}),
  );
  const kindOptions = Object.entries(kinds);
  const leftSelect = choice('Left of the slider', 'gallery-left', kindOptions, shown.left, value => {
    shown.left = value;
    show(shown.entry);
  });
  const rightSelect = choice('Right of the slider', 'gallery-right', kindOptions, shown.right, value => {
    shown.right = value;
    show(shown.entry);
  });
  const thumbs = element('div', {class: 'thumbs'});
  const fillThumbs = current =>
    thumbs.replaceChildren(
      ...gallery.entries
        .filter(entry => entry.map === current.map && viewKey(entry) === viewKey(current))
        .map(entry =>
          element(
            'figure',
            {'data-entry': gallery.entries.indexOf(entry)},
            element('img', {
              src: entry.render,
              alt: variantName(data.variants[entry.variant]),
              tabindex: 0,
              onclick: () => show(entry),
              onkeydown: event => {
                if (event.key === 'Enter') show(entry);
              },
            }),
            element('figcaption', {}, variantName(data.variants[entry.variant])),
          ),
        ),
    );

  section.append(
    element('div', {class: 'controls'}, mapSelect, variantSelect, viewSelect, leftSelect, rightSelect),
    element('div', {class: 'compare'}, element('div', {}, stage, slider, readout, scales), card),
    element('h3', {}, 'All variants of this map and view'),
    thumbs,
  );
  fillThumbs(first);
  gallery.show = show;
  await show(first);
}

function showPicture(item) {
  gallery.show?.(pictureOf(item));
  sectionOf('gallery').scrollIntoView();
}
