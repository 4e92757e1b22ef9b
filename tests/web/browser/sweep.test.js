// The sweep view, and the service behind a token.

import assert from 'node:assert/strict';
import {test} from 'node:test';

import {launch, open, Server, shoot, token} from './support.js';

test('a sheet fills in, restores from its link and opens its points', async t => {
  const [server, browser] = await Promise.all([Server.start(), launch()]);
  t.after(async () => {
    await browser.close();
    await server.stop();
  });
  const page = await open(browser, `${server.origin}/#size=256&samples=16&tab=sweep`);
  await page.locator('#sweep-count', {hasText: '15 points from 3 traced images'}).waitFor();
  const values = page.locator('[data-pointer="/axes/absorption"]');
  await values.fill('0, 1.5');
  await page.locator('[role=alert] .problem', {hasText: '/axes/absorption'}).waitFor();
  await values.fill('nothing');
  await page.locator('.sweep-axis .fault', {hasText: 'A list'}).waitFor();
  await values.fill('0, 0.6, 1');
  await page.locator('#sweep-scattering').check();
  await page.locator('[data-pointer="/axes/scattering"]').fill('0 to 0.8 in 2');
  await page.locator('#sweep-count', {hasText: '18 points from 6 traced images'}).waitFor();
  await page.locator('#sweep-start').click();
  await page.locator('.cell[data-state=shown]').first().waitFor();
  await page.locator('#sweep-status', {hasText: '18 of 18 points, succeeded'}).waitFor({timeout: 60_000});
  await page.waitForFunction(() => document.querySelectorAll('.cell[data-state=shown]').length === 18);
  assert.equal(await page.locator('#sheet-tables table').count(), 2);
  await shoot(page, 'sweep');
  const [saved] = await Promise.all([page.waitForEvent('download'), page.locator('#sweep-sheet').click()]);
  assert.equal(saved.suggestedFilename(), 'translucube-sheet.png');

  const again = await open(browser, page.url());
  await again.waitForFunction(() => document.querySelectorAll('.cell[data-state=shown]').length === 18);
  await again.getByLabel('Open absorption 0.6, roughness 0.3, scattering 0.8, red-glass').click();
  assert.ok(await again.locator('#explorer').isVisible());
  assert.equal(await again.locator('#axis-absorption').inputValue(), '0.6');
  assert.equal(await again.locator('#axis-scattering').inputValue(), '0.8');
  await again.waitForFunction(() => document.getElementById('picture').src.startsWith('blob:'));
  assert.deepEqual([...page.faults, ...again.faults], []);
});

test('where a token is needed the page asks for it, once for a tab', async t => {
  const {file, text} = await token();
  const [server, browser] = await Promise.all([Server.start(['--tokens', file]), launch()]);
  t.after(async () => {
    await browser.close();
    await server.stop();
  });
  assert.equal((await fetch(`${server.origin}/v1/absorbers`)).status, 401);
  const page = await open(browser, `${server.origin}/#size=256&samples=16`);
  await page.locator('#token-dialog').waitFor();
  await page.locator('#token').fill('not it');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.getElementById('token').value === '');
  await page.locator('#token-dialog').waitFor();
  await page.locator('#token').fill(text);
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.getElementById('picture').src.startsWith('blob:'));
  await page.reload();
  await page.waitForFunction(() => document.getElementById('picture').src.startsWith('blob:'));
  assert.ok(await page.locator('#token-dialog').isHidden());
  assert.deepEqual(page.faults, []);
});
