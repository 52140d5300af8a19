function result = limcycle (command, what, varargin)
% LIMCYCLE  Asks the program limcycle about a feedback loop with friction.
%
%   RESULT = LIMCYCLE (COMMAND, CASE)
%   RESULT = LIMCYCLE (COMMAND, CASE, NAME, VALUE, ...)
%
%   COMMAND  'predict', 'df', 'simulate', 'margin', ...: a command of the program
%   CASE     a case file, or a struct: a loop with the fields plant, controller, friction, element, error, reference
%            and load, or a whole case with the field loop or diagram beside others, such as simulate. Fields are named
%            as the keys of the case file. A plant or controller may be a system of the Control System Toolbox, or of
%            the package control of Octave.
%   NAME     an option of the command without its dashes, such as 'seed' or 'time_limit' (for --time-limit); VALUE true
%            sets an option that takes no value, a cell array gives it several times
%
%   RESULT is the JSON document as a struct (docs/formats.md): RESULT.cycles(1).period. Numbers that do not exist are
%   empty, or NaN within a matrix. RESULT.text is what the program prints, RESULT.exit_code its exit code.
%   Bad input is the error 'limcycle:input', with the message of the program.
%
%   The program is sought on the path of the system; the environment variable LIMCYCLE names another.
%
%   Example: a servo that hunts
%     loop.plant = struct ('kind', 'mass', 'mass', 1.0);
%     loop.controller = struct ('kind', 'pid', 'kp', 3.0, 'ki', 4.0, 'kd', 6.0);
%     loop.friction = struct ('kind', 'lugre', 'Fs', 1.5, 'Fc', 1.0, 'vs', 0.001, ...
%                             'sigma0', 1e5, 'sigma1', 316.2, 'sigma2', 0.4);
%     result = limcycle ('predict', loop);
%     result.cycles.period
%
%   See also LIMCYCLE_PREDICT, LIMCYCLE_DF, LIMCYCLE_SIMULATE.

  folder = tempname ();
  mkdir (folder);
  tidy = onCleanup (@() remove_folder (folder));
  if isstruct (what)
    text = limcycle_toml (what);
    what = fullfile (folder, 'case.toml');
    write_file (what, text);
  end
  document = fullfile (folder, 'result.json');
  words = [{program(), char(command)}, {char(what), '--quiet', '--json', document}, option_words(varargin)];
  % MATLAB's own libraries are not those that the program was built with.
  call = ['env -u LD_LIBRARY_PATH ', strjoin(cellfun (@quoted, words, 'UniformOutput', false), ' '), ' 2>&1'];
  [code, text] = system (call);
  if code == 2
    error ('limcycle:input', '%s', strtrim (text));
  elseif exist (document, 'file') ~= 2
    error ('limcycle:failed', 'limcycle ended with %d: %s', code, strtrim (text));
  end
  result = jsondecode (fileread (document));
  result.text = text;
  result.exit_code = code;
end

function name = program ()
  name = getenv ('LIMCYCLE');
  if isempty (name)
    name = 'limcycle';
  end
end

function words = option_words (options)
  if mod (numel (options), 2) ~= 0
    error ('limcycle:input', 'options come as pairs: name, value');
  end
  words = {};
  for k = 1:2:numel (options)
    flag = ['--', strrep(char (options{k}), '_', '-')];
    values = options{k + 1};
    if ~iscell (values)
      values = {values};
    end
    for value = values(:)'
      words = [words, one_option(flag, value{1})]; %#ok<AGROW>
    end
  end
end

function words = one_option (flag, value)
  if islogical (value)
    words = repmat ({flag}, 1, double (value));
  elseif isnumeric (value)
    words = {flag, sprintf('%.17g', value)};
  else
    words = {flag, char(value)};
  end
end

function word = quoted (word)
  word = ['''', strrep(word, '''', '''\'''''), ''''];
end

function write_file (name, text)
  file = fopen (name, 'w', 'n', 'UTF-8');
  fwrite (file, unicode2native (text, 'UTF-8'));
  fclose (file);
end

function remove_folder (folder)
  if exist ('confirm_recursive_rmdir', 'builtin')
    confirm_recursive_rmdir (false, 'local'); % Octave asks otherwise
  end
  rmdir (folder, 's');
end
