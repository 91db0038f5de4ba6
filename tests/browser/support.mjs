// What the tests share: the browser, a page that watches for complaints and requests, ways to wait.
import assert from 'node:assert/strict';
import {pathToFileURL} from 'node:url';

export const launchOptions = {
  executablePath: '/usr/bin/chromium',
  args: ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync'],
};
export const laptop = {width: 1440, height: 900};
export const phone = {width: 390, height: 844};
export const address = pathToFileURL(process.env.REPORT).href;

// Opens the report, gives the page to `use`, then fails on anything the page complained about or asked for.
export async function withPage(browser, options, use) {
  const context = await browser.newContext({viewport: laptop, acceptDownloads: true, reducedMotion: 'reduce', ...options});
  const page = await context.newPage();
  const problems = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && problems.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => problems.push(`error: ${error.message}`));
  page.on('request', (request) => {
    const url = request.url();
    if (url.split('#')[0] !== address && !/^(data|blob):/.test(url)) problems.push(`request: ${url}`);
  });
  try {
    await page.goto(address, {waitUntil: 'load'});
    await use(page);
    assert.deepEqual(problems, []);
  } finally {
    await context.close();
  }
}

export const figureIds = (page) => page.$$eval('main figure', (figures) => figures.map((figure) => figure.dataset.figure));
export const figure = (page, id) => page.locator(`figure[data-figure="${id}"]`);

export async function drawn(page, id) {
  const place = figure(page, id);
  await place.evaluate((element) => element.scrollIntoView({block: 'center', behavior: 'instant'}));
  await page.waitForFunction((name) => document.querySelector(`figure[data-figure="${name}"]`).dataset.state, id, {timeout: 20000});
  assert.equal(await place.getAttribute('data-state'), 'drawn', `figure ${id}`);
}

export async function drawAll(page) {
  for (const id of await figureIds(page)) await drawn(page, id);
}

// The markup of a chart's drawing.
export const drawing = (page, id) => figure(page, id).locator('.chart svg').evaluate((svg) => svg.outerHTML);
