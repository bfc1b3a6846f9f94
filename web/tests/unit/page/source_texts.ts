// SPDX-License-Identifier: Apache-2.0
// What the page's sources say themselves, and what of strings/en.ts they use: read by the compiler, not by patterns.
import { dirname, relative, resolve } from "node:path";
import ts from "typescript";

const root = resolve(__dirname, "../../..");
const source = resolve(root, "src");
const texts = resolve(source, "strings/en.ts");
const languages = [resolve(source, "strings.ts"), resolve(source, "strings")]; // the choice, and the texts

function program(): ts.Program {
  const read = ts.readConfigFile(resolve(root, "tsconfig.json"), (name) => ts.sys.readFile(name));
  const { options } = ts.parseJsonConfigFileContent(read.config, ts.sys, root);
  return ts.createProgram(["main.ts", "opening.ts", "recording.ts", "people/main.ts", "patient/main.ts"].map((entry) => resolve(source, entry)), options);
}

const made = program();
const checker = made.getTypeChecker();
const pageFiles = made.getSourceFiles().filter((file) => {
  const folder = dirname(file.fileName);
  const isText = languages.includes(file.fileName) || languages.includes(folder);
  return !isText && (folder === source || folder.startsWith(`${source}/`)) && !folder.startsWith(`${source}/gen`);
});

function visit(node: ts.Node, see: (node: ts.Node) => void): void {
  see(node);
  ts.forEachChild(node, (child) => visit(child, see));
}

// ---- literals

export interface Literal {
  readonly text: string;
  readonly place: string; // file:line
}

/// For programmers: names of modules and classes, what is thrown or written to the console.
function isTechnical(node: ts.Node): boolean {
  for (let at: ts.Node | undefined = node; at; at = at.parent) {
    if (ts.isImportDeclaration(at) || ts.isExportDeclaration(at) || ts.isThrowStatement(at) || ts.isTypeNode(at)) return true;
    if (ts.isPropertyAssignment(at) && at.name.getText() === "class") return true;
    if (ts.isNewExpression(at) && /Error$/.test(at.expression.getText())) return true;
    if (ts.isCallExpression(at) && at.expression.getText().startsWith("console.")) return true;
  }
  return false;
}

/// Every piece of text in quotes, templates included.
export function literals(): readonly Literal[] {
  const found: Literal[] = [];
  for (const file of pageFiles) {
    visit(file, (node) => {
      const text = ts.isStringLiteralLike(node) || ts.isTemplateHead(node) || ts.isTemplateMiddleOrTemplateTail(node) ? node.text : "";
      if (text.trim() === "" || isTechnical(node)) return;
      const line = file.getLineAndCharacterOfPosition(node.getStart()).line + 1;
      found.push({ text, place: `${relative(source, file.fileName)}:${line}` });
    });
  }
  return found;
}

// ---- use of the texts

const name = (property: ts.PropertyAssignment) => property.name.getText();

/// Texts, lists and tables of strings/en.ts, with where they stand.
function leaves(): ReadonlyMap<ts.Node, string> {
  const all = new Map<ts.Node, string>();
  const walk = (literal: ts.ObjectLiteralExpression, path: string) => {
    for (const property of literal.properties) {
      if (!ts.isPropertyAssignment(property)) continue;
      if (ts.isObjectLiteralExpression(property.initializer)) walk(property.initializer, `${path}${name(property)}.`);
      else all.set(property, `${path}${name(property)}`);
    }
  };
  visit(made.getSourceFile(texts)!, (node) => {
    if (ts.isVariableDeclaration(node) && node.name.getText() === "en" && node.initializer && ts.isObjectLiteralExpression(node.initializer)) walk(node.initializer, "");
  });
  return all;
}

/// Texts that nothing on the page shows. One is used where its name is said, or where its table is looked up by a value or listed.
export function unusedTexts(): readonly string[] {
  const unused = new Map(leaves());
  const count = unused.size;
  const useAll = (expression: ts.Expression) => {
    for (const declared of checker.getTypeAtLocation(expression).symbol?.declarations ?? []) {
      if (declared.getSourceFile().fileName === texts) visit(declared, (inner) => unused.delete(inner));
    }
  };
  for (const file of pageFiles) {
    visit(file, (node) => {
      if (ts.isIdentifier(node)) unused.delete(checker.getSymbolAtLocation(node)?.valueDeclaration ?? node);
      if (ts.isElementAccessExpression(node)) useAll(node.expression);
      if (ts.isCallExpression(node) && /^Object\.(keys|entries|values)$/.test(node.expression.getText())) node.arguments.forEach(useAll);
    });
  }
  if (count < 200) throw new Error(`only ${count} texts were found`);
  return [...unused.values()];
}
