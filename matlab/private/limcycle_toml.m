function text = limcycle_toml (what)
% LIMCYCLE_TOML  A case file of a struct: a whole case, or a loop.
%   Lists are rows or columns; complex numbers are zeros or poles. In a state space every number is a matrix.
  if ~isfield (what, 'loop') && ~isfield (what, 'diagram') && ~isfield (what, 'identify')
    what = struct ('loop', what);
  end
  text = '';
  for key = fieldnames (what)'
    text = [text, key{1}, ' = ', toml_value(key{1}, what.(key{1}), false), sprintf('\n')]; %#ok<AGROW>
  end
end

function text = toml_value (key, value, in_state_space)
  if isa (value, 'lti')
    value = state_space (key, value);
  end
  if isstruct (value) && isscalar (value)
    text = ['{', members(value), '}'];
  elseif isstruct (value) || iscell (value)
    text = items (key, value, in_state_space);
  elseif ischar (value) || isa (value, 'string')
    text = toml_text (char (value));
  elseif islogical (value) && isscalar (value)
    words = {'false', 'true'};
    text = words{value + 1};
  elseif isnumeric (value) && ~issparse (value)
    text = numbers (key, double (value), in_state_space);
  else
    error ('limcycle:input', '%s: a %s is nothing that a case file holds', key, class (value));
  end
end

function text = members (value)
  keys = fieldnames (value)';
  parts = cell (size (keys));
  in_state_space = isfield (value, 'kind') && strcmp (value.kind, 'state-space');
  for k = 1:numel (keys)
    parts{k} = [keys{k}, ' = ', toml_value(keys{k}, value.(keys{k}), in_state_space)];
  end
  text = strjoin (parts, ', ');
end

function text = items (key, value, in_state_space)
  parts = cell (1, numel (value));
  for k = 1:numel (value)
    if iscell (value)
      parts{k} = toml_value (key, value{k}, in_state_space);
    else
      parts{k} = toml_value (key, value(k), in_state_space);
    end
  end
  text = ['[', strjoin(parts, ', '), ']'];
end

function text = numbers (key, value, in_state_space)
  is_matrix = in_state_space && ~isempty (regexp (key, '^[ABCD](_\w+)?$', 'once')); % C of gms is a number
  if is_matrix || (~isempty (value) && ~isvector (value))
    rows = cell (1, size (value, 1));
    for k = 1:numel (rows)
      rows{k} = list (value(k, :));
    end
    text = ['[', strjoin(rows, ', '), ']'];
  elseif any (strcmp (key, {'numerator', 'denominator', 'zeros', 'poles'})) || ~isscalar (value)
    text = list (value);
  else
    text = number (value);
  end
end

function text = list (values)
  parts = cell (1, numel (values));
  for k = 1:numel (values)
    parts{k} = number (values(k));
  end
  text = ['[', strjoin(parts, ', '), ']'];
end

function text = number (value)
  if imag (value) ~= 0
    text = ['[', number(real (value)), ', ', number(imag (value)), ']'];
  elseif isnan (value) || isinf (value)
    text = lower (sprintf ('%f', value));
  elseif value == fix (value) && abs (value) < 1e15
    text = sprintf ('%d', value); % also where the case wants a whole number
  else
    text = sprintf ('%.17g', value);
  end
end

function text = toml_text (value)
  value = strrep (strrep (value, '\', '\\'), '"', '\"');
  value = strrep (strrep (strrep (value, sprintf ('\n'), '\n'), sprintf ('\t'), '\t'), sprintf ('\r'), '\r');
  text = ['"', value, '"'];
end

function plant = state_space (key, system)
  if isdt (system)
    error ('limcycle:input', '%s: the system is in discrete time; limcycle takes plants and controllers in continuous time', key);
  end
  if exist ('hasdelay', 'file') && hasdelay (system)
    error ('limcycle:input', '%s: the system has a dead time: give that as the key delay of a transfer function', key);
  end
  [A, B, C, D] = ssdata (system);
  plant = struct ('kind', 'state-space', 'A', A, 'B', B, 'C', C);
  if any (D(:) ~= 0)
    plant.D = D;
  end
end
