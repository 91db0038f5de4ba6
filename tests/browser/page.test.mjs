// A report as its reader sees and uses it.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import {chromium} from 'playwright-core';
import {drawAll, drawing, drawn, figure, figureIds, laptop, launchOptions, phone, withPage} from './support.mjs';

const output = process.env.OUTPUT;
const browser = await chromium.launch(launchOptions);
test.after(() => browser.close());

test('opens fast', async () => {
  await withPage(browser, {}, async (page) => {
    const {paint, load} = await page.evaluate(() => new Promise((resolve) => {
      const read = () => {
        const entry = performance.getEntriesByName('first-contentful-paint')[0];
        if (!entry) return setTimeout(read, 20);
        return resolve({paint: entry.startTime, load: performance.getEntriesByType('navigation')[0].loadEventEnd});
      };
      read();
    }));
    const begin = Date.now();
    await drawAll(page);
    const all = Date.now() - begin;
    const count = (await figureIds(page)).length;
    const size = fs.statSync(process.env.REPORT).size;
    const text = `page ${(size / 1e6).toFixed(2)} MB, first paint ${paint.toFixed(0)} ms, loaded ${load.toFixed(0)} ms, ` +
      `${count} charts drawn while scrolling in ${all} ms`;
    console.log(`# ${text}`);
    fs.writeFileSync(path.join(output, 'timing.txt'), `${text}\n`);
    assert.ok(paint <= 1500, text);  // wanted: 500
    assert.ok(load <= 6000, text);   // wanted: 2000
  });
});

test('every section has a heading, and the navigation leads there', async () => {
  for (const viewport of [laptop, phone])
    await withPage(browser, {viewport}, async (page) => {
      const links = page.locator('nav.sections a');
      const sections = page.locator('main > section');
      assert.equal(await links.count(), await sections.count());
      for (let k = 0; k < (await links.count()); ++k) {
        const heading = sections.nth(k).locator('h2');
        assert.ok((await heading.innerText()).trim().length > 0);
        const arrived = () => page.waitForFunction(([at]) => {
          const box = document.querySelectorAll('main > section h2')[at].getBoundingClientRect();
          return box.top >= -1 && box.bottom <= innerHeight;
        }, [k], {timeout: 3000});
        await links.nth(k).click();
        await arrived().catch(async () => {  // the row of links may have moved under the pointer
          await links.nth(k).click();
          await arrived();
        });
        await page.waitForFunction(([at]) => document.querySelectorAll('nav.sections a')[at].hasAttribute('aria-current') ||
          innerHeight + scrollY >= document.documentElement.scrollHeight - 2, [k]);
      }
    });
});

test('every chart is drawn inside its place', async () => {
  for (const viewport of [laptop, phone])
    await withPage(browser, {viewport}, async (page) => {
      for (const id of await figureIds(page)) {
        await drawn(page, id);
        const seen = await figure(page, id).locator('.chart').evaluate((place) => {
          const svg = place.querySelector('svg');
          return {marks: svg.querySelectorAll('.mark-line path, .mark-rect path, .mark-symbol path, .mark-area path, .mark-rule line').length,
            width: svg.getBoundingClientRect().width, room: place.clientWidth, height: svg.getBoundingClientRect().height,
            clipped: Number(svg.getAttribute('width')) - place.clientWidth};
        });
        assert.ok(seen.marks > 0 && seen.height > 40, `figure ${id}: ${JSON.stringify(seen)}`);
        assert.ok(seen.clipped <= 8, `figure ${id} is wider than its place: ${JSON.stringify(seen)}`);
      }
    });
});

test('the theme is chosen, followed and remembered', async () => {
  await withPage(browser, {colorScheme: 'light'}, async (page) => {
    const [first] = await figureIds(page);
    await drawn(page, first);
    const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const seen = {};
    for (const name of ['Light', 'Dark', 'Auto', 'Dark']) {
      const before = await drawing(page, first);
      await page.getByRole('radio', {name, exact: true}).check({force: true});
      assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), name === 'Dark' ? 'dark' : 'light');
      seen[name] = await background();
      await figure(page, first).evaluate((element) => element.scrollIntoView({block: 'center', behavior: 'instant'}));
      if (name === 'Dark' || name === 'Auto')
        await page.waitForFunction(([id, old]) => {
          const svg = document.querySelector(`figure[data-figure="${id}"] .chart svg`);
          return svg && svg.outerHTML !== old;
        }, [first, before]);
    }
    assert.notEqual(seen.Light, seen.Dark);
    assert.equal(seen.Light, seen.Auto);
    await page.reload();
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
    await page.getByRole('radio', {name: 'Auto', exact: true}).check({force: true});
    await page.emulateMedia({colorScheme: 'dark'});
    await page.waitForFunction(() => document.documentElement.dataset.theme === 'dark');
  });
});

test('every column sorts up, down and back', async () => {
  await withPage(browser, {}, async (page) => {
    const tables = page.locator('main table');
    for (let t = 0; t < (await tables.count()); ++t) {
      const table = tables.nth(t);
      const rows = () => table.evaluate((element) => [...element.tBodies[0].rows].map((row) => row.innerText));
      const original = await rows();
      if (original.length < 2) continue;
      const buttons = table.locator('thead button');
      assert.equal(await buttons.count(), await table.locator('thead th').count());
      for (let c = 0; c < (await buttons.count()); ++c) {
        const keys = () => table.evaluate((element, column) => [...element.tBodies[0].rows].map((row) => row.cells[column].dataset.value)
          .filter((value) => value !== undefined && value !== 'nan').map((value) => Number(value.replace('inf', 'Infinity'))), c);
        const state = () => table.locator('thead th').nth(c).getAttribute('aria-sort');
        await buttons.nth(c).focus();
        await page.keyboard.press('Enter');
        assert.equal(await state(), 'ascending');
        assert.deepEqual(await keys(), (await keys()).sort((a, b) => a - b));
        await buttons.nth(c).click();
        assert.equal(await state(), 'descending');
        assert.deepEqual(await keys(), (await keys()).sort((a, b) => b - a));
        await page.keyboard.press('Space');
        assert.equal(await state(), 'none');
        assert.deepEqual(await rows(), original);
      }
    }
  });
});

test('every choice of a chart changes it', async () => {
  await withPage(browser, {}, async (page) => {
    for (const id of await figureIds(page)) {
      const place = figure(page, id);
      for (const kind of ['select', 'segments']) {
        const controls = kind === 'select' ? place.locator('.controls select') : place.locator('.controls [role=radiogroup]');
        for (let k = 0; k < (await controls.count()); ++k) {
          await drawn(page, id);
          const options = kind === 'select' ? controls.nth(k).locator('option') : controls.nth(k).locator('input');
          const pictures = new Set();
          const count = await options.count();
          assert.ok(count >= 1);
          for (let o = count - 1; o >= 0; --o) {
            const before = Number(await place.getAttribute('data-changes'));
            const chosen = kind === 'select' ? await controls.nth(k).evaluate((element) => element.selectedIndex) === o : await options.nth(o).isChecked();
            if (!chosen) {
              if (kind === 'select') await controls.nth(k).selectOption({index: o});
              else await options.nth(o).check({force: true});
              await page.waitForFunction(([name, old]) => Number(document.querySelector(`figure[data-figure="${name}"]`).dataset.changes) > old, [id, before]);
            }
            pictures.add(await drawing(page, id));
          }
          assert.ok(count === 1 || pictures.size > 1, `figure ${id}: its control changes nothing`);
        }
      }
    }
  });
});

test('the menu of every figure saves and shows', async () => {
  await withPage(browser, {}, async (page) => {
    for (const id of await figureIds(page)) {
      await drawn(page, id);
      const menu = figure(page, id).locator('.menu');
      const choose = async (name) => {
        await menu.locator('summary').click();
        await menu.getByRole('button', {name}).click();
        assert.equal(await menu.getAttribute('open'), null);
      };
      const saved = async (action) => {
        const [download] = await Promise.all([page.waitForEvent('download'), action()]);
        return {name: download.suggestedFilename(), bytes: fs.readFileSync(await download.path())};
      };
      const svg = await saved(() => choose('Save as SVG'));
      assert.equal(svg.name, `${id}.svg`);
      assert.match(svg.bytes.toString(), /^<svg /);
      const png = await saved(() => choose('Save as PNG'));
      assert.equal(png.name, `${id}.png`);
      assert.equal(png.bytes.subarray(1, 4).toString(), 'PNG');
      await choose('Show the data');
      assert.ok((await page.locator('dialog tbody tr').count()) > 0);
      const csv = await saved(() => page.locator('dialog button', {hasText: 'Save'}).first().click());
      assert.match(csv.name, /\.csv$/);
      assert.ok(csv.bytes.length > 10);
      await page.keyboard.press('Escape');
      await page.locator('dialog').waitFor({state: 'detached'});
      await choose('Show the specification');
      JSON.parse(await page.locator('dialog pre').innerText());
      await page.getByRole('button', {name: 'Close'}).click();
      await page.locator('dialog').waitFor({state: 'detached'});
      await menu.locator('summary').click();
      await page.keyboard.press('Escape');
      assert.equal(await menu.getAttribute('open'), null);
    }
    const licences = page.locator('details.licences');
    await licences.locator('summary').click();
    assert.match(await licences.innerText(), /Redistribution and use in source and binary forms/);
  });
});

test('the tabulator key reaches everything, and one sees where it is', async () => {
  await withPage(browser, {}, async (page) => {
    await drawAll(page);
    await page.evaluate(() => scrollTo(0, 0));
    const wanted = await page.evaluate(() => {
      const all = [...document.querySelectorAll('a[href], button, select, input, summary, [tabindex="0"]')]
        .filter((element) => element.checkVisibility());
      const groups = new Set();
      const reachable = all.filter((element) => element.type !== 'radio' || (element.checked && !groups.has(element.name) && groups.add(element.name)));
      reachable.forEach((element, k) => (element.dataset.stop = k));
      return reachable.length;
    });
    const stops = new Set();
    for (let k = 0; k < wanted + 5 && stops.size < wanted; ++k) {
      await page.keyboard.press('Tab');
      const seen = await page.evaluate(() => {
        const element = document.activeElement;
        const shown = element.type === 'radio' ? element.nextElementSibling : element;
        const style = getComputedStyle(shown);
        return {stop: element.dataset.stop, name: element.outerHTML.slice(0, 90), outline: style.outlineStyle, width: parseFloat(style.outlineWidth)};
      });
      if (seen.stop === undefined) continue;
      stops.add(seen.stop);
      assert.ok(seen.outline !== 'none' && seen.width >= 1.5, `no visible focus: ${seen.name}`);
    }
    assert.equal(stops.size, wanted);
  });
});

test('text and lines stand out from the background', async () => {
  for (const colorScheme of ['light', 'dark'])
    await withPage(browser, {colorScheme}, async (page) => {
      await drawAll(page);
      const weak = await page.evaluate(() => {
        const canvas = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
        const rgba = (colour) => {
          canvas.clearRect(0, 0, 1, 1);
          canvas.fillStyle = colour;
          canvas.fillRect(0, 0, 1, 1);
          return [...canvas.getImageData(0, 0, 1, 1).data];
        };
        const luminance = ([r, g, b]) => [r, g, b].map((v) => (v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4))
          .reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
        const contrast = (a, b) => {
          const [x, y] = [luminance(rgba(a)), luminance(rgba(b))];
          return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05);
        };
        const behind = (element) => {
          for (let at = element; at; at = at.parentElement) {
            const colour = getComputedStyle(at).backgroundColor;
            if (rgba(colour)[3] === 255) return colour;
          }
          return 'white';
        };
        const found = new Set();
        const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
        while (walker.nextNode()) {
          const element = walker.currentNode.parentElement;
          if (!walker.currentNode.data.trim() || !element.checkVisibility() || element.closest('script, style')) continue;
          const style = getComputedStyle(element);
          const colour = element.closest('svg') ? style.fill : style.color;
          const value = contrast(colour, behind(element.closest('svg')?.parentElement ?? element));
          if (value < 4.5) found.add(`${element.tagName} ${element.className} '${walker.currentNode.data.trim().slice(0, 30)}' ${value.toFixed(2)}`);
        }
        const page = getComputedStyle(document.body).backgroundColor;
        for (const colour of odobenchTheme.colours[odobenchTheme.current()].categories)
          if (contrast(colour, page) < 3) found.add(`series ${colour} ${contrast(colour, page).toFixed(2)}`);
        return [...found];
      });
      assert.deepEqual(weak, [], colorScheme);
    });
});

test('nothing sticks out of a phone, and sections look as on the pictures', async () => {
  for (const [device, viewport] of Object.entries({laptop, phone}))
    for (const colorScheme of ['light', 'dark'])
      await withPage(browser, {viewport, colorScheme}, async (page) => {
        await drawAll(page);
        const {page: width, window} = await page.evaluate(() => ({page: document.documentElement.scrollWidth, window: innerWidth}));
        assert.ok(width <= window, `${device}: the page is ${width} px wide in a window of ${window} px`);
        await page.evaluate(() => scrollTo(0, 0));
        await page.screenshot({path: path.join(output, `${device}-${colorScheme}-top.png`)});
        for (const section of await page.locator('main > section').all())
          await section.screenshot({path: path.join(output, `${device}-${colorScheme}-${await section.getAttribute('id')}.png`)});
      });
});

test('print draws every chart, also those never scrolled to', async () => {
  await withPage(browser, {colorScheme: 'dark'}, async (page) => {
    const begin = Date.now();
    await page.pdf({path: path.join(output, 'print.pdf'), format: 'A4', preferCSSPageSize: true, printBackground: true});
    console.log(`# printed in ${Date.now() - begin} ms`);
    const states = await page.$$eval('main figure', (figures) => figures.map((figure) => figure.dataset.state));
    assert.deepEqual([...new Set(states)], ['drawn']);
    assert.equal(await page.locator('table.paper').count(), 0);
    await drawAll(page);
  });
});

test('tables hold the numbers of the report, with every digit', {skip: !process.env.TABLES && 'TABLES is not set'}, async () => {
  const {tables} = JSON.parse(fs.readFileSync(process.env.TABLES, 'utf8'));
  await withPage(browser, {}, async (page) => {
    const shown = await page.$$eval('main table', (list) => list.map((table) => ({
      id: table.dataset.table,
      columns: [...table.tHead.rows[0].cells].map((cell) => cell.dataset.id),
      rows: [...table.tBodies[0].rows].map((row) => [...row.cells].map((cell) => ({...cell.dataset, text: cell.innerText}))),
    })));
    // A page may leave columns out, and show tables that the JSON has not; several tables may have one id.
    const compare = (table, seen) => table.rows.forEach((row, r) => seen.columns.forEach((column, c) => {
      assert.ok(table.columns.some(({id}) => id === column), `${table.id}: column ${column}`);
      const cell = row[column];
      const {value, difference, text} = seen.rows[r][c];
      const wanted = cell !== null && typeof cell === 'object' ? cell.value : cell;
      if (typeof wanted === 'number') assert.equal(Number(value), wanted);
      else if (typeof wanted === 'string') assert.ok(text.startsWith(wanted), text);
      else assert.ok(value === undefined || /^(nan|-?inf)$/.test(value));
      if (typeof cell?.difference === 'number') assert.equal(Number(difference), cell.difference);
    }));
    let compared = 0;
    for (const seen of shown) {
      const candidates = tables.filter((table) => table.id === seen.id && table.rows.length === seen.rows.length);
      if (!tables.some((table) => table.id === seen.id)) continue;
      const complaints = candidates.map((table) => {
        try {
          return compare(table, seen);
        } catch (error) {
          return error;
        }
      });
      if (!complaints.includes(undefined)) throw complaints[0] ?? new Error(`${seen.id}: no table has as many rows`);
      ++compared;
    }
    // A verdict is sentences there, and no table.
    const text = await page.locator('main').innerText();
    const verdicts = tables.filter((table) => table.id.endsWith('verdict'));
    for (const row of verdicts.flatMap((table) => table.rows)) assert.ok(text.includes(row.sentence), row.sentence);
    const ids = new Set(shown.map((table) => table.id));
    const others = tables.filter((table) => !verdicts.includes(table));
    for (const table of others) assert.ok(ids.has(table.id), `${table.id} is not on the page`);
    assert.ok(compared >= new Set(others.map((table) => table.id)).size);
  });
});

test('tables are there without JavaScript', async () => {
  await withPage(browser, {javaScriptEnabled: false}, async (page) => {
    for (const table of await page.locator('main table').all()) assert.ok(await table.isVisible());
    assert.ok(await page.locator('main h2').first().isVisible());
  });
});
