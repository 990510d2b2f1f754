// Draws files with three.js in headless Chromium: `node draw.mjs OUT_FOLDER FILE.glb...`, one PNG each.
// An animated file is drawn at four moments, side by side. Fails where a file cannot be loaded.
import { createServer } from 'node:http';
import { readFile, writeFile } from 'node:fs/promises';
import { basename, join, resolve } from 'node:path';
import puppeteer from 'puppeteer-core';

const [out, ...files] = process.argv.slice(2);
const here = import.meta.dirname;
const TYPES = { html: 'text/html', js: 'text/javascript', mjs: 'text/javascript', glb: 'model/gltf-binary' };

const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    const number = /^\/model\/(\d+)$/.exec(path);
    try {
        const file = number ? resolve(files[Number(number[1])]) : join(here, path);
        response.setHeader('Content-Type', TYPES[file.split('.').pop()] ?? 'application/octet-stream');
        response.end(await readFile(file));
    } catch (error) {
        response.statusCode = 404;
        response.end(String(error));
    }
});
await new Promise(listening => server.listen(0, '127.0.0.1', listening));
const browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
let failed = false;
try {
    const page = await browser.newPage();
    page.on('console', message => console.log(`  ${message.text()}`));
    page.setDefaultTimeout(300_000);
    await page.goto(`http://127.0.0.1:${server.address().port}/draw.html`);
    await page.waitForFunction('window.draw !== undefined');
    for (const [number, file] of files.entries()) {
        try {
            const { picture, told } = await page.evaluate(url => window.draw(url), `/model/${number}`);
            const png = join(out, `${basename(file, '.glb')}_three.png`);
            await writeFile(png, Buffer.from(picture.split(',')[1], 'base64'));
            console.log(`${png}: ${told}`);
        } catch (error) {
            failed = true;
            console.error(`${file}: ${error}`);
        }
    }
} finally {
    await browser.close();
    server.close();
}
process.exit(failed ? 1 : 0);
