// Yarn: each instance is one curve between two points of the yarn, read from a texture with its two neighbors.

const state = `
uniform sampler2D uState;
uniform int uWidth;
vec4 stateOf(float stitch) {
  int id = int(stitch + 0.5);
  return texelFetch(uState, ivec2(id % uWidth, id / uWidth), 0);
}
`;

const light = `
uniform float uDim;
vec3 lit(vec3 color, vec3 normal, float shade, float mark) {
  vec3 n = normalize(normal);
  float key = max(dot(n, normalize(vec3(0.45, 0.65, 0.75))), 0.0);
  float fill = max(dot(n, normalize(vec3(-0.7, 0.1, 0.5))), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  vec3 c = color * (0.34 + 0.20 * sky + 0.50 * key + 0.14 * fill) * shade;
  vec3 dimmed = mix(vec3(dot(c, vec3(0.3, 0.6, 0.1))), c, 0.35) * 0.75 + 0.12;
  c = mix(c, dimmed, uDim * (1.0 - mark));
  return mix(c, vec3(1.0, 0.82, 0.15), mark * 0.45);
}
`;

export const yarnVertex = `
precision highp sampler2D;
in float aSegment;
uniform sampler2D uPoints;
uniform float uRadius;
${state}
out vec3 vNormal;
out vec3 vColor;
out float vMark;
out float vShade;
out float vPly;

vec4 texel(int i) { return texelFetch(uPoints, ivec2(i % 1024, i / 1024), 0); }
vec4 pointAt(int i) { return texel(2 * i); }
vec4 sideAt(int i) { return texel(2 * i + 1); }

vec3 way(vec3 before, vec3 at, vec3 after) {
  vec3 to = at - before;
  vec3 from = after - at;
  float a = length(to), b = length(from);
  vec3 w = (a > 1e-6 ? to / a : vec3(0.0)) * b + (b > 1e-6 ? from / b : vec3(0.0)) * a;
  float l = length(w);
  return l > 1e-9 ? w / l : (b > 1e-6 ? from / b : (a > 1e-6 ? to / a : vec3(1.0, 0.0, 0.0)));
}

void main() {
  int i = int(aSegment + 0.5);
  vec4 p0 = pointAt(i - 1), p1 = pointAt(i), p2 = pointAt(i + 1), p3 = pointAt(i + 2);
  vec4 s1 = sideAt(i), s2 = sideAt(i + 1);
  float third = distance(p1.xyz, p2.xyz) / 3.0;
  vec3 a = p1.xyz, d = p2.xyz;
  vec3 b = a + way(p0.xyz, a, d) * third;
  vec3 c = d - way(a, d, p3.xyz) * third;
  float t = position.x, s = 1.0 - t;
  vec3 at = a * s * s * s + b * 3.0 * s * s * t + c * 3.0 * s * t * t + d * t * t * t;
  vec3 slope = (b - a) * s * s + (c - b) * 2.0 * s * t + (d - c) * t * t;
  vec3 tangent = length(slope) > 1e-9 ? normalize(slope) : normalize(d - a + vec3(1e-6));
  vec3 side = mix(s1.xyz, s2.xyz, t);
  side = normalize(side - tangent * dot(side, tangent));
  vec3 normal = side * position.y + cross(tangent, side) * position.z;
  vec4 look = stateOf(p1.w);
  vColor = look.rgb;
  vMark = look.a;
  float depth = mix(s1.w, s2.w, t);
  vShade = mix(0.55, 1.0, smoothstep(0.05, 0.85, depth));
  vPly = atan(position.z, position.y) * 2.0 + (float(i) + t) * 1.9;
  vNormal = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(at + normal * uRadius, 1.0);
}
`;

export const yarnFragment = `
precision highp float;
in vec3 vNormal;
in vec3 vColor;
in float vMark;
in float vShade;
in float vPly;
out vec4 color;
${light}
void main() {
  float ply = 0.86 + 0.14 * smoothstep(-0.6, 0.9, sin(vPly));
  color = vec4(pow(lit(vColor, vNormal, vShade * ply, vMark), vec3(1.0 / 1.15)), 1.0);
}
`;

export const tileVertex = `
precision highp sampler2D;
in vec3 aOut;
in float aStitch;
uniform float uLift;
${state}
out vec3 vNormal;
out vec3 vColor;
out float vMark;
flat out float vStitch;
void main() {
  vec4 look = stateOf(aStitch);
  vColor = look.rgb;
  vMark = look.a;
  vStitch = aStitch;
  vNormal = normalMatrix * aOut;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position + aOut * uLift, 1.0);
}
`;

export const tileFragment = `
precision highp float;
in vec3 vNormal;
in vec3 vColor;
in float vMark;
flat in float vStitch;
out vec4 color;
uniform bool uPick;
${light}
void main() {
  if (uPick) {
    int id = int(vStitch + 1.5);
    color = vec4(float(id & 255), float((id >> 8) & 255), float((id >> 16) & 255), 255.0) / 255.0;
    return;
  }
  vec3 n = gl_FrontFacing ? vNormal : -vNormal;
  color = vec4(lit(vColor, n, 1.0, vMark), 1.0);
}
`;

export const lineVertex = `
in vec3 aOut;
in vec3 aColor;
uniform float uLift;
out vec3 vColor;
void main() {
  vColor = aColor;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position + aOut * uLift, 1.0);
}
`;

export const lineFragment = `
precision highp float;
in vec3 vColor;
out vec4 color;
void main() { color = vec4(vColor, 1.0); }
`;
