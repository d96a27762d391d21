;; Eglot, without a window, asks the server of a text with a mistake, mends it and says what it was answered.
;; VLAPROBE_PROGRAM, VLAPROBE_FOLDER (with things.probe and user.probe), VLAPROBE_TOLD.
(setq debug-on-error nil
      eglot-autoshutdown nil
      eglot-sync-connect 30
      eglot-connect-timeout 30
      vc-handled-backends nil)
(require 'eglot)
(require 'cl-lib)

(defvar told-file (getenv "VLAPROBE_TOLD"))
(defun tell (format &rest values)
  (append-to-file (concat (apply #'format format values) "\n") nil told-file))
(defun wait-for (what)
  (let ((limit (+ (float-time) 30)) answer)
    (while (and (not (setq answer (funcall what))) (< (float-time) limit))
      (accept-process-output nil 0.05))
    (or answer (error "NOTHING CAME"))))

;; The lines of dsl/editor/README.md, with the program where it is here.
(define-derived-mode probe-mode prog-mode "Probe" (setq-local comment-start "# "))
(add-to-list 'auto-mode-alist '("\\.probe\\'" . probe-mode))
(add-to-list 'eglot-server-programs `(probe-mode ,(getenv "VLAPROBE_PROGRAM") "lsp"))

(condition-case mistake
    (let ((default-directory (file-name-as-directory (getenv "VLAPROBE_FOLDER"))))
      (find-file "user.probe")
      (apply #'eglot (eglot--guess-contact))
      (tell "server: %s" (plist-get (eglot--server-info (eglot-current-server)) :name))
      (flymake-mode 1)
      (cl-flet ((said () (mapcar (lambda (one) (flymake-diagnostic-text one)) (flymake-diagnostics))))
        (tell "diagnostics: %s" (car (split-string (car (wait-for #'said)) "\n")))
        (goto-char (point-min))
        (search-forward "color")
        (backward-char 2)
        (let* ((hover (jsonrpc-request (eglot-current-server) :textDocument/hover (eglot--TextDocumentPositionParams)))
               (value (plist-get (plist-get hover :contents) :value)))
          (tell "hover: %s" (replace-regexp-in-string "\n" " " value)))
        (goto-char (point-min))
        (search-forward "like bal")
        (let ((capf (eglot-completion-at-point)))
          (tell "completion: %s" (string-join (all-completions "bal" (nth 2 capf)) " ")))
        (insert "l")
        (eglot--signal-textDocument/didChange) ; else when Emacs idles, which it does not here
        (wait-for (lambda () (null (said))))
        (tell "mended: yes")
        (backward-char 1)
        (let ((places (xref-backend-definitions 'eglot (xref-backend-identifier-at-point 'eglot))))
          (tell "definition: %s" (string-trim (xref-item-summary (car places)))))
        (cl-letf (((symbol-function 'y-or-n-p) (lambda (&rest _) t))) ; another file is changed, too
          (eglot-rename "globe"))
        (tell "rename: %s" (string-trim (buffer-string))))
      (set-buffer-modified-p nil)
      (eglot-shutdown (eglot-current-server))
      (tell "end: done"))
  (error (tell "FAILED: %S" mistake)))
(dolist (buffer (buffer-list)) (with-current-buffer buffer (set-buffer-modified-p nil)))
(kill-emacs 0)
