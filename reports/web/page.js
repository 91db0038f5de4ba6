// What the page does besides charts: the choice of a theme, tables that sort, the section one is in.
(function () {
  'use strict';
  const theme = globalThis.odobenchTheme;

  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.append(...children);
    return made;
  }

  function addThemeSwitch(place) {
    const group = element('div', {class: 'segments', role: 'radiogroup', 'aria-label': 'Colours of the page'});
    for (const [value, name] of [['auto', 'Auto'], ['light', 'Light'], ['dark', 'Dark']]) {
      const input = element('input', {type: 'radio', name: 'theme', value, autocomplete: 'off'});
      input.checked = theme.choice() === value;
      input.addEventListener('change', () => theme.choose(value));
      group.append(element('label', {}, input, element('span', {}, name)));
    }
    place.append(group);
  }

  // -- Sorting. A click sorts up, the next one down, the third restores the order of the report.

  function cellKey(cell) {
    const {value} = cell.dataset;
    if (value !== undefined) return value === 'inf' ? Infinity : value === '-inf' ? -Infinity : Number(value);
    const text = cell.textContent.trim();
    return text === '' || text === '–' ? null : text;
  }

  // Numbers before text, nothing (and not-a-number) last in either direction.
  function compare(a, b, direction) {
    const rank = (key) => (key === null || Number.isNaN(key) ? 2 : typeof key === 'number' ? 0 : 1);
    const ranks = rank(a) - rank(b);
    if (ranks !== 0 || rank(a) === 2) return ranks;
    if (typeof a === 'number') return direction * (a < b ? -1 : a > b ? 1 : 0);
    return direction * a.localeCompare(b, 'en', {numeric: true});
  }

  function sortBy(table, column, state) {
    const rows = [...table.original];
    if (state !== 'none') {
      const direction = state === 'ascending' ? 1 : -1;
      const keys = new Map(rows.map((row) => [row, cellKey(row.cells[column])]));
      rows.sort((a, b) => compare(keys.get(a), keys.get(b), direction));
    }
    table.tBodies[0].append(...rows);
  }

  function makeSortable(table) {
    if (table.tBodies[0].rows.length < 2) return;
    table.original = [...table.tBodies[0].rows];
    const headings = [...table.tHead.rows[0].cells];
    headings.forEach((heading, column) => {
      const button = element('button', {type: 'button', title: 'Sort'}, ...heading.childNodes);
      heading.append(button);
      heading.setAttribute('aria-sort', 'none');
      button.addEventListener('click', () => {
        const next = {none: 'ascending', ascending: 'descending', descending: 'none'}[heading.getAttribute('aria-sort')];
        for (const other of headings) other.setAttribute('aria-sort', other === heading ? next : 'none');
        sortBy(table, column, next);
      });
    });
  }

  // A table that fits needs no scrolling, hence no stop for the keyboard.
  function watchScrolling(wrapper) {
    const update = () => {
      const hidden = wrapper.scrollWidth - wrapper.clientWidth;
      if (hidden > 1) wrapper.setAttribute('tabindex', '0');
      else wrapper.removeAttribute('tabindex');
      wrapper.classList.toggle('scrolled', wrapper.scrollLeft > 0);
      wrapper.classList.toggle('more', wrapper.scrollLeft < hidden - 1);
    };
    new ResizeObserver(update).observe(wrapper);
    wrapper.addEventListener('scroll', update, {passive: true});
  }

  // -- On paper nothing scrolls: differences go below their numbers where a table is too wide, then it is made smaller.

  function fitToPaper(table) {
    const paper = 670;  // px, of a sheet of A4 between its margins
    table.classList.add('paper');
    if (table.offsetWidth > paper) table.classList.add('stacked');
    if (table.offsetWidth > paper) table.style.zoom = paper / table.offsetWidth;
  }
  function leavePaper(table) {
    table.classList.remove('paper', 'stacked');
    table.style.zoom = '';
  }

  // -- The section that begins above the middle of the window is the one being read.

  function watchSections() {
    const links = new Map([...document.querySelectorAll('nav.sections a')].map((link) => [link.hash.slice(1), link]));
    const sections = [...document.querySelectorAll('main > section')];
    let scheduled = false;
    let shown = null;
    const update = () => {
      scheduled = false;
      const atEnd = innerHeight + scrollY >= document.documentElement.scrollHeight - 2;
      const above = sections.filter((section) => section.getBoundingClientRect().top < innerHeight * 0.4);
      const now = atEnd && scrollY > 0 ? sections.at(-1) : above.at(-1) ?? sections[0];
      if (!now || now === shown) return;
      shown = now;
      for (const [id, link] of links) {
        if (id === now.id) link.setAttribute('aria-current', 'true');
        else link.removeAttribute('aria-current');
      }
      const link = links.get(now.id);
      const nav = link?.closest('nav');
      if (nav && nav.scrollWidth > nav.clientWidth) nav.scrollTo({left: link.offsetLeft - nav.clientWidth / 3});
    };
    const schedule = () => {
      if (!scheduled) requestAnimationFrame(update);
      scheduled = true;
    };
    addEventListener('scroll', schedule, {passive: true});
    addEventListener('resize', schedule);
    schedule();
  }

  addThemeSwitch(document.getElementById('theme'));
  document.querySelectorAll('main table').forEach(makeSortable);
  document.querySelectorAll('main .scroll').forEach(watchScrolling);
  watchSections();
  addEventListener('beforeprint', () => document.querySelectorAll('main table').forEach(fitToPaper));
  addEventListener('afterprint', () => document.querySelectorAll('main table').forEach(leavePaper));
})();
