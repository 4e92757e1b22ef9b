// The explorer in a browser, over the real service and renderer.

import assert from 'node:assert/strict';
import {readFile} from 'node:fs/promises';
import {after, before, test} from 'node:test';

import {anotherPicture, launch, open, pictureHash, pictureTimes, Server, shoot} from './support.js';

const axe = await readFile(new URL('../node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');
// What is quick to trace, and small.
const quick = 'size=256&samples=4';

let server, browser;
before(async () => {
  [server, browser] = await Promise.all([Server.start(), launch()]);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

async function opened(t, hash = quick, options = {}) {
  const page = await open(browser, `${server.origin}/#${hash}`, options);
  t.after(async () => {
    assert.deepEqual(page.faults, []);
    await page.context().close();
  });
  return page;
}

/// All samples are there, and so is their picture.
async function finished(page) {
  await page.waitForFunction(() => document.getElementById('progress').value === 1 &&
      /^Finished/.test(document.getElementById('announce').textContent), null, {timeout: 60_000});
  await page.waitForFunction(() => document.getElementById('picture').src.startsWith('blob:'));
}

async function setSlider(page, axis, value) {
  const before = (await pictureTimes(page)).length;
  await page.locator(`#axis-${axis}`).evaluate((slider, to) => {
    slider.value = to;
    slider.dispatchEvent(new Event('input', {bubbles: true}));
    slider.dispatchEvent(new Event('change', {bubbles: true}));
  }, value);
  await page.waitForFunction(
      count => performance.getEntriesByName('picture').length > count, before);
}

async function expectAccessible(page, name) {
  await page.evaluate(axe);  // as a debugger would: the page's policy allows no script of others
  const {violations} = await page.evaluate(() => window.axe.run());
  const serious = violations.filter(({impact}) => impact === 'serious' || impact === 'critical');
  assert.deepEqual(serious.map(({id, nodes}) => [id, nodes.map(({target}) => target.join(' '))]), [], name);
}

test('the page loads, and shows a picture that grows', async t => {
  const page = await opened(t, 'samples=16');
  await page.waitForFunction(() => document.getElementById('picture').src.startsWith('blob:'));
  await shoot(page, 'first-view');
  await finished(page);
  assert.match(await page.locator('#status').textContent(), /512 px · 16 of 16 samples · error [0-9.]+ %/);
  await shoot(page, 'desktop-light');
});

test('the first picture of another material is there in 200 ms', async t => {
  const page = await opened(t);
  await finished(page);
  for (const roughness of [0.3, 0.35, 0.4, 0.45, 0.5]) {
    await setSlider(page, 'roughness', roughness);
    await finished(page);
  }
  const times = (await pictureTimes(page)).slice(-5);
  t.diagnostic(`from the change to its picture: ${times.map(Math.round).join(', ')} ms`);
  assert.ok(Math.min(...times) < 200, `${times}`);  // what else runs on the machine only adds
});

test('dragging the point of the cube moves along two axes', async t => {
  const page = await opened(t, `absorption=0.5&roughness=0.5&scattering=0.5&${quick}`);
  await finished(page);
  const first = await pictureHash(page);
  const {x, y, width, height} = await page.locator('#cube').boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + 30, y + height / 2 - 25, {steps: 6});
  await page.mouse.up();
  const [absorption, roughness, scattering] = await Promise.all(
      ['absorption', 'roughness', 'scattering'].map(axis => page.locator(`#axis-${axis}`).inputValue()));
  assert.ok(Number(absorption) > 0.55, absorption);
  assert.ok(Number(scattering) > 0.55, scattering);
  assert.equal(Number(roughness), 0.5);
  await finished(page);
  await anotherPicture(page, first);
  assert.match(page.url(), new RegExp(`absorption=0\\.[5-9].*scattering=0\\.[5-9]`));

  // The background turns the cube and moves nothing.
  const url = page.url();
  await page.mouse.move(x + 8, y + 8);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 20, {steps: 4});
  await page.mouse.up();
  assert.equal(page.url(), url);
});

test('absorption and absorber change without a new trace', async t => {
  const page = await opened(t);
  await finished(page);
  const traced = await server.tracedImages(), developed = await server.developedImages();
  assert.ok(traced > 0);
  const seen = new Set([await pictureHash(page)]);
  for (const absorption of [0.1, 0.5, 0.9, 1]) {
    await setSlider(page, 'absorption', absorption);
    seen.add(await pictureHash(page));
  }
  const before = (await pictureTimes(page)).length;
  await page.locator('#named-amber').check();
  await page.waitForFunction(count => performance.getEntriesByName('picture').length > count, before);
  await setSlider(page, 'absorption', 0.6);
  seen.add(await pictureHash(page));
  assert.equal(seen.size, 6, 'each is another picture');
  assert.equal(await server.tracedImages(), traced);
  assert.ok(await server.developedImages() >= developed + 6);
  const times = (await pictureTimes(page)).slice(-6);
  t.diagnostic(`in the page: ${times.map(Math.round).join(', ')} ms`);
});

test('the service develops another absorber in 50 ms', async t => {
  const made = await (await server.post('/v1/renders', {
    material: {cube: {absorption: 0, roughness: 0.2, scattering: 0.4}}, explorable: true,
    image: {width: 256, height: 256}, quality: {samples: 16},
  })).json();
  await server.json(`/v1/renders/${made.id}?wait=30`);
  const times = [];
  for (let i = 0; i < 11; ++i) {
    const start = performance.now();
    const answer = await fetch(
        `${server.origin}/v1/renders/${made.id}/image?format=png&absorption=${0.3 + i / 50}&absorber=tea`);
    await answer.arrayBuffer();
    times.push(performance.now() - start);
    assert.equal(answer.status, 200);
  }
  t.diagnostic(`256 x 256, PNG, with the way there and back: ${times.map(Math.round).join(', ')} ms`);
  assert.ok(Math.min(...times) < 50, `${times}`);
});

test('the keyboard reaches and moves everything', async t => {
  const page = await opened(t);
  await page.locator('#axis-scattering').focus();
  await page.keyboard.press('ArrowRight');
  assert.equal(await page.locator('#axis-scattering').inputValue(), '0.355');
  await page.locator('#cube').focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('PageUp');
  assert.equal(await page.locator('#axis-absorption').inputValue(), '0.37');
  assert.equal(await page.locator('#axis-roughness').inputValue(), '0.17');
  // Through the page and out of it: no trap.
  const visited = new Set();
  await page.locator('#tab-explorer').focus();
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press('Tab');
    visited.add(await page.evaluate(() => document.activeElement.id || document.activeElement.tagName));
    if (visited.has('BODY')) break;
  }
  for (const id of ['pin', 'cube', 'axis-absorption', 'show-request']) assert.ok(visited.has(id), id);
  assert.ok(visited.has('BODY'), 'the focus leaves the page at its end');
});

test('who changes one control and goes on to the next finds it there', async t => {
  const page = await opened(t);
  const ior = page.locator('[data-pointer="/material/ior"]'), g = page.locator('[data-pointer="/material/anisotropy"]');
  await ior.fill('1.4');
  await g.click();
  assert.ok(await g.evaluate(control => control === document.activeElement));
  await page.keyboard.press('Control+a');
  await page.keyboard.type('0.25');
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.dataset.pointer), '/material/pigment');
  assert.match(page.url(), /ior=1\.4&anisotropy=0\.25/);
});

test('objects, a backdrop and an oil film have the controls that the service lists', async t => {
  const page = await opened(t);
  await finished(page);
  const {objects} = await server.json('/v1/objects');
  const choose = page.locator('[data-pointer="/scene/object"]');
  assert.deepEqual(await choose.locator('option').allTextContents(), objects.map(({name}) => name));
  const box = objects.find(({name}) => name === 'box');
  const shown = await pictureHash(page);
  await choose.selectOption('box');
  for (const {name} of box.parameters)
    assert.ok(await page.locator(`[data-pointer="/scene/object/${name}"]`).isVisible(), name);
  await page.locator('[data-pointer="/scene/backdrop"]').check();
  await page.locator('[data-pointer="/material/oil_film"]').check();
  await finished(page);
  await anotherPicture(page, shown);
  assert.equal(await page.locator('[role=alert] .problem').count(), 0);
  assert.match(decodeURIComponent(page.url()), /object=\{"type":"box".*oil_film=\{.*backdrop=\{/);
});

test('a link restores the view', async t => {
  const page = await opened(t,
      `absorption=0.8&roughness=0.1&scattering=0.6&absorber=%7B%22rgb%22%3A%5B0.2%2C0.5%2C1%5D%7D&ior=1.4&environment=sunrise&${quick}`);
  await finished(page);
  assert.equal(await page.locator('#axis-absorption').inputValue(), '0.8');
  assert.equal(await page.locator('[data-pointer="/material/ior"]').inputValue(), '1.4');
  assert.equal(await page.locator('[data-pointer="/scene/environment"]').inputValue(), 'sunrise');
  assert.ok(await page.locator('#absorber-color').isChecked());
  const hash = await pictureHash(page);
  const again = await opened(t, new URL(page.url()).hash.slice(1));
  await finished(again);
  assert.equal(await pictureHash(again), hash);
});

test('views are pinned, set side by side and wiped', async t => {
  const page = await opened(t);
  await finished(page);
  await page.locator('#pin').click();
  await setSlider(page, 'absorption', 0.9);
  await page.locator('#pin').click();
  assert.equal(await page.locator('.pin').count(), 2);
  await page.locator('.pin').first().getByText('Beside').click();
  assert.ok(await page.locator('#other-picture').isVisible());
  await shoot(page, 'side-by-side');
  await page.locator('.pin').first().getByText('Wipe').click();
  const box = await page.locator('#view').boundingBox();
  await page.mouse.move(box.x + box.width * 0.2, box.y + 50);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.4, box.y + 50, {steps: 3});
  await page.mouse.up();
  assert.ok(Math.abs(Number(await page.locator('#wipe-at').inputValue()) - 40) < 2);
  await shoot(page, 'wipe');
  await page.locator('.pin .thumb').first().click();
  assert.equal(await page.locator('#axis-absorption').inputValue(), '0.35');
  await page.locator('.pin').first().getByText('Remove').click();
  assert.ok(await page.locator('#frame-other').isHidden());
});

test('the request of a picture is one that the service takes; files are saved', async t => {
  const page = await opened(t, `anisotropy=0.3&pigment=0.01&${quick}`);
  await finished(page);
  await page.locator('#show-request').click();
  const request = JSON.parse(await page.locator('#request-json').inputValue());
  assert.ok((await server.post('/v1/renders', request)).ok);
  assert.match(await page.locator('#request-curl').inputValue(), /^curl .*\/v1\/renders /);
  await page.locator('#request-close').click();
  for (const format of ['png', 'exr']) {
    const [saved] = await Promise.all(
        [page.waitForEvent('download'), page.locator(`#download-${format}`).click()]);
    assert.match(saved.suggestedFilename(), new RegExp(`\\.${format}$`));
    const bytes = await readFile(await saved.path());
    assert.equal(bytes.subarray(0, 4).toString('latin1'), format === 'png' ? '\x89PNG' : 'v/1\x01');
  }
});

test('what the service refuses is shown where it is wrong', async t => {
  const page = await opened(t);
  const ior = page.locator('[data-pointer="/material/ior"]');
  await ior.fill('9');
  await ior.press('Enter');
  const problem = page.locator('[role=alert] .problem');
  await problem.waitFor();
  assert.match(await problem.textContent(), /\/material\/ior/);
  assert.equal(await ior.getAttribute('aria-invalid'), 'true');
  await shoot(page, 'refused');
  await ior.fill('1.6');
  await ior.press('Enter');
  await problem.waitFor({state: 'detached'});
  await finished(page);
});

test('an own spectrum and a colour absorb', async t => {
  const page = await opened(t);
  await finished(page);
  const traced = await server.tracedImages(), first = await pictureHash(page);
  await page.locator('#absorber-spectrum').check();
  await page.locator('#absorber-table').fill('400 0\n500 0\n600 1\n700 1');
  await page.locator('#absorber-table').blur();
  const second = await anotherPicture(page, first);
  await page.locator('#absorber-table').fill('400 1');
  await page.locator('#absorber-table').blur();
  assert.match(await page.locator('#absorber-fault').textContent(), /Two lines/);
  await page.locator('#absorber-color').check();
  await anotherPicture(page, second);
  assert.equal(await server.tracedImages(), traced);
});

test('axe finds nothing serious, in light and dark, on a desk and on a phone', async t => {
  const page = await opened(t);
  await finished(page);
  await page.locator('#pin').click();
  await expectAccessible(page, 'light');
  await page.locator('#show-request').click();
  await expectAccessible(page, 'dialog');
  await page.locator('#request-close').click();
  await page.locator('#tab-sweep').click();
  await expectAccessible(page, 'sweep');

  const dark = await opened(t, 'size=384&samples=16', {colorScheme: 'dark'});
  await finished(dark);
  await expectAccessible(dark, 'dark');
  await shoot(dark, 'desktop-dark');

  const phone = await opened(t, 'size=384&samples=16', {viewport: {width: 390, height: 844}, hasTouch: true, reducedMotion: 'reduce'});
  await finished(phone);
  await expectAccessible(phone, 'phone');
  const overflow = await phone.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(overflow <= 0, `${overflow} px too wide`);
  await shoot(phone, 'phone', {fullPage: true});
});
