// Starts `qsr lsp` and connects it to the editor; colours work without it.
"use strict";

const vscode = require("vscode");

let client;

function clientLibrary() {
  try {
    return require("vscode-languageclient/node");
  } catch {
    return undefined;
  }
}

async function start() {
  const library = clientLibrary();
  if (library === undefined) {
    vscode.window.showWarningMessage(
      "qsr: only colours are available; run 'npm install' in the folder of this extension for findings, hover and completion."
    );
    return;
  }
  const command = vscode.workspace.getConfiguration("qsr").get("command", "qsr");
  const server = { command, args: ["lsp"] };
  client = new library.LanguageClient("qsr", "qsr", server, {
    documentSelector: [{ language: "qsr" }],
    synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/*.qsr") },
  });
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    vscode.window.showErrorMessage(
      `qsr: '${command} lsp' does not start (${error.message}); set 'qsr.command' to the qsr command of your environment.`
    );
  }
}

async function stop() {
  const running = client;
  client = undefined;
  if (running !== undefined) {
    await running.stop();
  }
}

async function restart() {
  await stop();
  await start();
}

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("qsr.restart", restart),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("qsr.command")) {
        restart();
      }
    })
  );
  await start();
}

module.exports = { activate, deactivate: stop };
