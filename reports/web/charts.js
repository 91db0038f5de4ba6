// Draws the figures when they come into view, as wide as there is room, in the colours of the page; controls and menu of each.
// The chart library lies in the page as text and is run when the first chart needs it.
(function () {
  'use strict';
  const theme = globalThis.odobenchTheme;
  const printWidth = 660; // px, of a sheet of A4 between its margins
  const axisRoom = 70;    // px beside each view, a first guess

  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.append(...children);
    return made;
  }

  function loadLibrary() {
    if (globalThis.vegaLite) return;
    for (const text of document.querySelectorAll('script.chart-library'))
      document.head.append(element('script', {}, text.textContent));
  }

  // -- Specifications and data: JSON in the page, read when needed.

  const parsed = new Map();
  function json(selector) {
    if (!parsed.has(selector)) parsed.set(selector, JSON.parse(document.querySelector(selector).textContent));
    return parsed.get(selector);
  }
  const specification = (id) => json(`script[data-figure="${CSS.escape(id)}"]`);
  const dataset = (name) => json(`script[data-dataset="${CSS.escape(name)}"]`);

  function walk(node, visit) {
    if (node === null || typeof node !== 'object') return;
    visit(node);
    for (const child of Object.values(node)) walk(child, visit);
  }

  function datasetNames(spec) {
    const names = new Set();
    walk(spec, (node) => node.data?.name !== undefined && names.add(node.data.name));
    return [...names];
  }

  // With the text of the data sets inline; the same as standalone() of reports/document.cpp.
  function standalone(spec) {
    const copy = structuredClone(spec);
    walk(copy, (node) => {
      if (node.data?.name === undefined) return;
      const {name, ...rest} = node.data;
      node.data = {...rest, values: dataset(name)};
    });
    return copy;
  }

  // -- Width: what the specification says is for print.

  const isUnit = (spec) => Boolean(spec.mark || spec.layer);
  const facetChannels = ['facet', 'row', 'column'];
  const isFaceted = (spec) => facetChannels.some((channel) => spec.encoding?.[channel]);

  // Views side by side: at most `allowed`; returns how many there are.
  function setColumns(spec, allowed) {
    if (spec.hconcat) {
      const count = spec.hconcat.length;
      if (count <= allowed) return count;
      spec.concat = spec.hconcat;
      delete spec.hconcat;
      return (spec.columns = allowed);
    }
    if (spec.vconcat) return Math.max(...spec.vconcat.map((view) => (isUnit(view) ? 1 : setColumns(view, allowed))));
    if (spec.encoding?.facet) {
      const facet = spec.encoding.facet;
      return (facet.columns = Math.min(facet.columns ?? allowed, allowed));
    }
    if (spec.encoding?.column || spec.facet?.column) return spec.usermeta?.odobench?.columns ?? 1;
    if (spec.encoding?.row || spec.facet?.row) return 1;
    if (spec.concat) return (spec.columns = Math.min(spec.columns ?? spec.concat.length, allowed));
    if (spec.facet || spec.repeat) {
      const count = Array.isArray(spec.repeat) ? spec.repeat.length : Infinity;
      return (spec.columns = Math.min(spec.columns ?? allowed, allowed, count));
    }
    return 1;
  }

  // The widest row of views: the sum of their widths and how many they are.
  function widestRow(spec, columns) {
    const views = spec.hconcat ?? spec.concat ?? spec.vconcat;
    if (!views) {
      const width = spec.spec ? widestRow(spec.spec, 1).width : typeof spec.width === 'number' ? spec.width : 0;
      return {width: width * columns, count: columns};
    }
    const perRow = spec.hconcat ? views.length : spec.vconcat ? 1 : columns;
    let widest = {width: 0, count: 1};
    for (let at = 0; at < views.length; at += perRow) {
      const row = views.slice(at, at + perRow).map((view) => widestRow(view, isUnit(view) ? 1 : columns));
      const total = {width: row.reduce((sum, view) => sum + view.width, 0), count: row.reduce((sum, view) => sum + view.count, 0)};
      if (total.width > widest.width) widest = total;
    }
    return widest;
  }

  function scaleViews(spec, factor, keepAspect) {
    walk(spec, (node) => {
      if (typeof node.width === 'number' && (isUnit(node) || node.spec || node === spec)) {
        node.width = Math.max(40, Math.round(node.width * factor));
        if (keepAspect && typeof node.height === 'number') node.height = Math.max(40, Math.round(node.height * factor));
      }
    });
  }

  // `spec` for `room` px; `excess` is what a first drawing was wider than the room. "aspect": "equal" in usermeta.odobench keeps
  // the ratio of width and height, for maps.
  function fitted(spec, room, excess = 0) {
    const meta = spec.usermeta?.odobench ?? {};
    if (isUnit(spec) && !isFaceted(spec)) {
      const aspect = meta.aspect === 'equal' && spec.height > 0 ? spec.width / spec.height : 0;
      if (aspect) {
        scaleViews(spec, Math.min(1.25, (room - axisRoom - excess) / spec.width), true);
      } else if (typeof spec.width !== 'object') {
        spec.width = room;
        spec.autosize = {type: 'fit-x', contains: 'padding'};
      }
      return spec;
    }
    const wanted = meta.columns ?? 4;
    const narrowest = Math.max(150, Math.min(250, widestRow(spec, 1).width));
    const columns = setColumns(spec, Math.max(1, Math.min(wanted, Math.floor(room / narrowest))));
    const row = widestRow(spec, columns);
    if (row.width > 0) {
      const free = room - row.count * axisRoom - (row.count - 1) * 24 - excess;
      const factor = Math.max(0.1, free / row.width);
      scaleViews(spec, meta.aspect === 'equal' ? Math.min(1.25, factor) : factor, meta.aspect === 'equal');
    }
    return spec;
  }

  // -- One view of a specification.

  function makeView(spec, themeName, width, layout, options) {
    const logger = vega.logger(vega.Warn);
    const warn = logger.warn;
    // It means selections, but says so for every parameter.
    logger.warn = (...text) => (/^Selection not supported for/.test(text[0]) ? logger : warn.apply(logger, text));
    const compiled = vegaLite.compile(spec, {config: theme.config(themeName, width, layout), logger}).spec;
    return new vega.View(vega.parse(compiled), {logLevel: vega.Warn, ...options});
  }

  const tooltip = {
    box: null,
    show(event, value) {
      this.box ??= document.body.appendChild(element('div', {id: 'tooltip', role: 'status'}));
      if (value === null || value === undefined || value === '') {
        this.box.style.display = 'none';
        return;
      }
      const list = element('dl');
      if (typeof value === 'object')
        for (const [name, text] of Object.entries(value)) list.append(element('dt', {}, name), element('dd', {}, String(text)));
      this.box.replaceChildren(typeof value === 'object' ? list : String(value));
      this.box.style.display = 'block';
      const {width, height} = this.box.getBoundingClientRect();
      const left = Math.min(event.clientX + 14, innerWidth - width - 6);
      const top = event.clientY + 16 + height > innerHeight ? event.clientY - height - 12 : event.clientY + 16;
      this.box.style.transform = `translate(${Math.max(4, left)}px, ${Math.max(4, top)}px)`;
    },
  };

  class Chart {
    constructor(figure) {
      this.figure = figure;
      this.id = figure.dataset.figure;
      this.place = figure.querySelector('.chart');
      this.title = figure.querySelector('h3').textContent.trim();
      this.place.setAttribute('role', 'img');
      this.place.setAttribute('aria-label', this.title);
      this.values = {};  // of the parameters that the controls set
      this.near = false;
      this.known = {};   // what the last drawing told
      this.drawn = '';   // theme and width of the drawing
      this.busy = Promise.resolve();
    }

    get spec() {
      return specification(this.id);
    }

    wanted() {
      return `${theme.current()} ${Math.floor(this.place.clientWidth)}`;
    }

    // Draws, or draws again, what is out of date; one after the other.
    refresh() {
      if (this.near && this.drawn !== this.wanted())
        this.busy = this.busy.then(() => this.drawn !== this.wanted() && this.draw(theme.current(), this.place.clientWidth));
      return this.busy;
    }

    async draw(themeName, room) {
      this.drawn = `${themeName} ${Math.floor(room)}`;
      try {
        loadLibrary();
        this.place.style.minHeight = `${this.place.offsetHeight}px`;
        const view = await this.fit(themeName, room);
        this.view?.finalize();
        this.view = view;
        this.place.style.minHeight = `${this.place.querySelector('svg').getBoundingClientRect().height}px`;
        this.figure.dataset.state = 'drawn';
      } catch (error) {
        this.figure.dataset.state = 'failed';
        this.place.replaceChildren(element('p', {class: 'missing'}, `This chart cannot be drawn: ${error.message}`));
        console.error(`figure ${this.id}:`, error);
      }
    }

    // Drawn anew where only a drawing tells how much room axes and names take; remembered for the next drawing of this width.
    async fit(themeName, room) {
      let {excess, layout} = this.known.room === room ? this.known : {excess: 0, layout: theme.firstLayout};
      for (let attempt = 1;; ++attempt) {
        const spec = fitted(standalone(this.spec), room - 2, excess);
        this.place.replaceChildren();
        const view = makeView(spec, themeName, room, layout, {
          renderer: 'svg', container: this.place, hover: true, tooltip: (_, event, item, value) => tooltip.show(event, value),
        });
        for (const [name, value] of Object.entries(this.values)) view.signal(name, value);
        await view.runAsync();
        const natural = Number(this.place.querySelector('svg').getAttribute('width'));
        const better = theme.betterLayout(view, room, layout);
        const full = spec.autosize || spec.usermeta?.odobench?.aspect === 'equal' || natural > room - 24;
        const fits = natural <= room && full;
        this.known = {room, excess, layout};
        if ((fits && !better) || attempt === 3) return view;
        if (!fits && !better) excess += natural - (room - 4);
        layout = better ?? layout;
        view.finalize();
      }
    }

    async set(name, value) {
      this.values[name] = value;
      await this.busy;
      if (this.view) await this.view.signal(name, value).runAsync();
      this.figure.dataset.changes = Number(this.figure.dataset.changes ?? 0) + 1;
    }

    // As the specification says, in the colours of print, with what the controls are set to.
    async forExport() {
      loadLibrary();
      let layout = theme.firstLayout;
      for (;;) {
        const view = makeView(standalone(this.spec), 'print', printWidth, layout, {renderer: 'none'});
        for (const [name, value] of Object.entries(this.values)) view.signal(name, value);
        await view.runAsync();
        const better = theme.betterLayout(view, printWidth, layout);
        if (!better) return view;
        layout = better;
      }
    }
  }

  // -- Controls.

  function segments(chart, control, number, current) {
    const group = element('div', {class: 'segments', role: 'radiogroup', 'aria-label': control.label});
    control.options.forEach((option) => {
      const input = element('input', {type: 'radio', name: `control-${number}-${control.param}`, autocomplete: 'off'});
      input.checked = option.value === current;
      input.addEventListener('change', () => chart.set(control.param, option.value));
      group.append(element('label', {}, input, element('span', {}, option.label)));
    });
    return element('div', {class: 'control'}, element('span', {class: 'name', 'aria-hidden': 'true'}, control.label), group);
  }

  function selection(chart, control, current) {
    const select = element('select', {autocomplete: 'off'});
    for (const option of control.options) {
      const made = element('option', {}, option.label);
      made.selected = option.value === current;
      select.append(made);
    }
    select.addEventListener('change', () => chart.set(control.param, control.options[select.selectedIndex].value));
    return element('label', {class: 'control'}, element('span', {class: 'name'}, control.label), select);
  }

  function addControls(chart, number) {
    const controls = chart.spec.usermeta?.odobench?.controls ?? [];
    if (controls.length === 0) return;
    const bar = element('div', {class: 'controls'});
    for (const control of controls) {
      const current = chart.spec.params?.find((param) => param.name === control.param)?.value;
      const short = control.options.length <= 4 && control.options.every((option) => option.label.length <= 24);
      bar.append(short ? segments(chart, control, number, current) : selection(chart, control, current));
    }
    chart.place.before(bar);
  }

  // -- Menu: files, data, specification.

  function save(name, type, content) {
    const url = content instanceof Blob ? URL.createObjectURL(content) : URL.createObjectURL(new Blob([content], {type}));
    const link = element('a', {href: url, download: name});
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  }

  async function savePng(chart) {
    const canvas = await (await chart.forExport()).toCanvas(2);
    canvas.toBlob((blob) => save(`${chart.id}.png`, 'image/png', blob));
  }

  function openDialog(title, buttons, ...content) {
    const close = element('button', {type: 'button', class: 'button'}, 'Close');
    const head = element('header', {}, element('h3', {}, title), ...buttons, close);
    const dialog = element('dialog', {'aria-label': title}, head, element('div', {class: 'body', tabindex: '0'}, ...content));
    close.addEventListener('click', () => dialog.close());
    dialog.addEventListener('click', (event) => event.target === dialog && dialog.close());
    dialog.addEventListener('close', () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
  }

  function saveButton(label, name, type, content) {
    const button = element('button', {type: 'button', class: 'button'}, label);
    button.addEventListener('click', () => save(name, type, content));
    return button;
  }

  function dataTable(name, text) {
    const most = 500;
    const rows = vega.read(text, {type: 'csv', parse: {}});
    const names = rows.columns ?? Object.keys(rows[0] ?? {});
    const body = element('tbody');
    for (const row of rows.slice(0, most)) body.append(element('tr', {}, ...names.map((column) => element('td', {}, row[column] ?? ''))));
    const note = rows.length > most ? `The first ${most} of ${rows.length} rows; the file has all.` : `${rows.length} rows.`;
    const table = element('table', {}, element('caption', {}, element('span', {}, name)),
      element('thead', {}, element('tr', {}, ...names.map((column) => element('th', {scope: 'col'}, column)))), body);
    return [table, element('p', {class: 'notes'}, note)];
  }

  function showData(chart) {
    loadLibrary();
    const names = datasetNames(chart.spec);
    const buttons = names.map((name) => saveButton(names.length > 1 ? `Save ${name}.csv` : 'Save CSV', `${name}.csv`, 'text/csv', dataset(name)));
    openDialog(chart.title, buttons, ...names.flatMap((name) => dataTable(name, dataset(name))));
  }

  function showSpecification(chart) {
    const whole = () => JSON.stringify(standalone(chart.spec), null, 2);
    const saving = element('button', {type: 'button', class: 'button'}, 'Save with data');
    saving.addEventListener('click', () => save(`${chart.id}.vl.json`, 'application/json', whole()));
    openDialog(chart.title, [saving], element('pre', {}, JSON.stringify(chart.spec, null, 2)));
  }

  function addMenu(chart) {
    const actions = [
      ['Save as SVG', async () => save(`${chart.id}.svg`, 'image/svg+xml', await (await chart.forExport()).toSVG())],
      ['Save as PNG', () => savePng(chart)],
      ['Show the data', () => showData(chart)],
      ['Show the specification', () => showSpecification(chart)],
    ];
    const list = element('div');
    const menu = element('details', {class: 'menu'}, element('summary', {'aria-label': `Export: ${chart.title}`}, 'Export ▾'), list);
    for (const [name, action] of actions) {
      const button = element('button', {type: 'button'}, name);
      button.addEventListener('click', () => {
        menu.open = false;
        menu.firstElementChild.focus();
        action();
      });
      list.append(button);
    }
    menu.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape' || !menu.open) return;
      menu.open = false;
      menu.firstElementChild.focus();
    });
    menu.addEventListener('focusout', (event) => {
      if (event.relatedTarget && !menu.contains(event.relatedTarget)) menu.open = false;
    });
    chart.figure.querySelector('.figure-head').append(menu);
  }
  document.addEventListener('pointerdown', (event) => {
    for (const menu of document.querySelectorAll('.menu[open]')) if (!menu.contains(event.target)) menu.open = false;
  });

  // -- When to draw.

  const charts = new Map();
  document.querySelectorAll('main figure').forEach((figure, number) => {
    const chart = new Chart(figure);
    charts.set(chart.place, chart);
    addControls(chart, number);
    addMenu(chart);
  });

  let queue = Promise.resolve();
  const pause = () => new Promise((resolve) => setTimeout(resolve, 0));
  function enqueue(chart) {
    queue = queue.then(() => chart.refresh()).then(pause);
  }
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const chart = charts.get(entry.target);
      chart.near = entry.isIntersecting;
      if (chart.near) enqueue(chart);
    }
  }, {rootMargin: '500px 0px'});
  for (const place of charts.keys()) observer.observe(place);

  let timer = 0;
  let printing = false;
  const refreshAll = () => {
    for (const chart of charts.values()) if (chart.near && !printing) enqueue(chart);
  };
  const later = () => {
    clearTimeout(timer);
    timer = setTimeout(refreshAll, 150);
  };
  document.addEventListener('odobench:theme', later);
  const resizing = new ResizeObserver(later);
  resizing.observe(document.querySelector('main'));

  // Before print every chart is drawn anew; drawing waits for nothing but promises, which are settled when the handler
  // returns.
  addEventListener('beforeprint', () => {
    printing = true;
    for (const chart of charts.values()) chart.draw('print', printWidth);
  });
  addEventListener('afterprint', () => {
    printing = false;
    refreshAll();
  });
})();
