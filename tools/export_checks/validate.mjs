// The Khronos glTF validator on files: `node validate.mjs FILE.glb...`. Fails where it finds an error.
import { readFile } from 'node:fs/promises';
import { validateBytes } from 'gltf-validator';

const SEVERITIES = ['error', 'warning', 'information', 'hint'];
let errors = 0;
for (const file of process.argv.slice(2)) {
    const report = await validateBytes(new Uint8Array(await readFile(file)), { maxIssues: 0 });
    const { issues, info } = report;
    errors += issues.numErrors;
    console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ${issues.numInfos} informations, ` +
        `${issues.numHints} hints; ${info.totalVertexCount} vertices, ${info.totalTriangleCount} triangles`);
    const counts = new Map();
    for (const { severity, code, message } of issues.messages) {
        const line = `  ${SEVERITIES[severity]} ${code}: ${message}`;
        counts.set(line, (counts.get(line) ?? 0) + 1);
    }
    counts.forEach((count, line) => console.log(`${line} (${count} times)`));
}
process.exit(errors > 0 ? 1 : 0);
