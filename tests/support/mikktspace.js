// Writes the tangents that Mikkelsen's own code gives, as the npm package mikktspace carries it.
// usage: node mikktspace.js FOLDER_OF_mikktspace IN OUT: floats of position, normal and coordinates, each array whole, of
// triangles' corners; then four floats a corner.
const fs = require('fs');
const path = require('path');

const [modules, from, to] = process.argv.slice(2);
const mikktspace = require(path.join(modules, 'mikktspace'));
const bytes = fs.readFileSync(from);
const floats = new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const corners = floats.length / 8;
const tangents = mikktspace.generateTangents(floats.slice(0, 3 * corners), floats.slice(3 * corners, 6 * corners),
                                             floats.slice(6 * corners));
fs.writeFileSync(to, Buffer.from(tangents.buffer, tangents.byteOffset, tangents.byteLength));
