// The service in a process of its own, and a browser that looks at it.

import {spawn} from 'node:child_process';
import {mkdtemp, mkdir, rm, writeFile} from 'node:fs/promises';
import {readFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import path from 'node:path';

import {chromium} from 'playwright-core';

const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../../..');
const binary = process.env.TRANSLUCUBE_BINARY ?? path.join(root, 'build/release/bin/translucube');
const pictures = process.env.WEB_PICTURES ?? path.join(root, 'build/web');
// Where the page's files are taken from a folder, a change needs no build.
const webFolder = process.env.WEB_FOLDER;

export class Server {
  static async start(more = []) {
    const server = new Server();
    server.data = await mkdtemp(path.join(tmpdir(), 'translucube-web-'));
    server.process = spawn(binary, ['serve', '--port', '0', '--data', server.data, ...more],
        {stdio: ['ignore', 'pipe', 'ignore']});
    server.origin = await new Promise((resolve, reject) => {
      let text = '';
      server.process.stdout.on('data', data => {
        text += data;
        const found = /listening on (http:\S+)/.exec(text);
        if (found) resolve(found[1]);
      });
      server.process.on('exit', () => reject(new Error('the service ended')));
    });
    return server;
  }

  async stop() {
    const ended = new Promise(resolve => this.process.on('exit', resolve));
    this.process.kill();
    await ended;
    await rm(this.data, {recursive: true, force: true});
  }

  async json(where, options) {
    return (await fetch(this.origin + where, options)).json();
  }

  post(where, body) {
    return fetch(this.origin + where, {
      method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body),
    });
  }

  /// Images that cost paths, as the service counts them.
  async tracedImages() {
    const text = await (await fetch(`${this.origin}/metrics`)).text();
    return Number(/^translucube_images_total\{[^}]*"traced"[^}]*\} (\d+)/m.exec(text)?.[1] ?? 0);
  }

  async developedImages() {
    const text = await (await fetch(`${this.origin}/metrics`)).text();
    return Number(/^translucube_images_total\{[^}]*"developed"[^}]*\} (\d+)/m.exec(text)?.[1] ?? 0);
  }
}

export async function token() {
  const child = spawn(binary, ['token', '--name', 'web'], {stdio: ['ignore', 'pipe', 'inherit']});
  let text = '';
  for await (const part of child.stdout) text += part;
  const entry = /\{.*\}/.exec(text)[0];
  const file = path.join(await mkdtemp(path.join(tmpdir(), 'translucube-token-')), 'tokens.json');
  await writeFile(file, `{"tokens": [${entry}]}`);
  return {file, text: /once:\s+(\S+)/.exec(text)[1]};
}

export async function launch() {
  await mkdir(pictures, {recursive: true});
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: [
      '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync',
    ],
  });
}

/// A page of a context of its own; `faults` collects what a browser complains of.
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 860}, ...options});
  const page = await context.newPage();
  page.faults = [];
  page.on('pageerror', error => page.faults.push(String(error)));
  page.on('console', message => {
    if (message.type() !== 'error') return;
    // Refusals of the service are logged by the browser too; the page shows them.
    if (!/Failed to load resource/.test(message.text())) page.faults.push(message.text());
  });
  if (webFolder)
    await page.route(/\/web\/[a-z-]+\.(js|css|svg)$|\/(#.*)?$/, async route => {
      const name = path.basename(new URL(route.request().url()).pathname) || 'index.html';
      const types = {js: 'text/javascript', css: 'text/css', svg: 'image/svg+xml', html: 'text/html'};
      const response = await route.fetch();
      await route.fulfill({
        response, body: await readFile(path.join(webFolder, name)), contentType: types[name.split('.').at(-1)],
      });
    });
  await page.goto(url);
  return page;
}

export function shoot(page, name, options = {}) {
  return page.screenshot({path: path.join(pictures, `${name}.png`), ...options});
}

/// The bytes of the picture that is shown.
export function pictureHash(page) {
  return page.evaluate(async () => {
    const image = document.getElementById('picture');
    if (!image.src.startsWith('blob:')) return '';
    await image.decode();
    const canvas = new OffscreenCanvas(image.naturalWidth, image.naturalHeight);
    const paint = canvas.getContext('2d');
    paint.drawImage(image, 0, 0);
    const {data} = paint.getImageData(0, 0, canvas.width, canvas.height);
    const hash = await crypto.subtle.digest('SHA-256', data);
    return [...new Uint8Array(hash)].map(byte => byte.toString(16)).join('');
  });
}

/// The hash of the first picture that is not SHOWN: a page may show the same one once more.
export async function anotherPicture(page, shown) {
  for (const until = Date.now() + 10_000; Date.now() < until; await page.waitForTimeout(20)) {
    const hash = await pictureHash(page);
    if (hash !== shown) return hash;
  }
  throw new Error('the picture stays the same');
}

/// Milliseconds from each change to the picture that shows it, in order.
export function pictureTimes(page) {
  return page.evaluate(() => performance.getEntriesByName('picture').map(({duration}) => duration));
}
