// A surface of triangles: x, y, z of three corners each, outside anticlockwise.
import { THREE } from "nicegui-scene";

export default class Surface {
  create_geometry(corners) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
    geometry.computeVertexNormals();
    return geometry;
  }
}
